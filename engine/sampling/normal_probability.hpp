#pragma once

namespace steerstat {

/// Standard normal distribution function, P(Z <= z); the same bits on every machine.
///
/// Relative error below 2e-15 for z >= -37; below that the probability leaves the normal doubles. Takes microseconds:
/// for constants of a distribution, not for draws.
///
/// Sources: the series of [Marsaglia 2004] in the middle, Laplace's continued fraction in the tails [NIST 2010, 7.9].
double normal_probability(double z);

/// The same within a relative error of 2e-15, by other bits, in tens of nanoseconds: for draws.
///
/// Sources: the rational approximations of [Cody 1969].
double quick_normal_probability(double z);

/// The same as a coordinate of a design: no nearer to 0 and 1 than designs draw, 2^-53, though a sum of normal
/// variables may lie beyond what theirs can be, and a draw of a proposal too (whose weight is that of z all the same).
double coordinate_of_normal(double z);

}  // namespace steerstat
