// The Taylor series of the closed loop, a pack of trials at a time. Included once by a source compiled for an
// instruction set, after its pack; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// Runs `body.template operator()<k>()` for k = first ... last - 1, unrolled.
template <int first, int last, class Body>
[[gnu::always_inline]] inline void unroll(Body&& body) {
  if constexpr (first < last) {
    body.template operator()<first>();
    unroll<first + 1, last>(body);
  }
}

/// What the closed loop of a trial is made of: (1)-(2) of the true plant under the linearising force of the nominal
/// one.
///
/// The first joint is scaled by the true coupling K: E = K (q1 - q1_goal), V = K q1_dot, b = K a. With
/// y = sin(q2) q2_dot, whose derivative collects the centrifugal terms and the inertia coupling of both equations,
///     V' = mismatch y' + drive b - damping V + belief (sin^2(q2) (V' - ratio b) - slip y)
///     q2_ddot = sin(q2) V' - slip q2_dot
/// which takes four and a half convolutions an order and no division of series.
template <class Real>
struct LoopConstants {
  Real slip;      ///< [1/s] f2 / (I2 + m2 d2^2)
  Real mismatch;  ///< K (true - nominal m2 d2) / (m1 + m2)
  Real drive;     ///< nominal (m1 + m2) / (m1 + m2)
  Real damping;   ///< [1/s] f1 / (m1 + m2)
  Real belief;    ///< K nominal m2 d2 / (m1 + m2)
  Real ratio;     ///< K nominal / K
};

/// The law for b as a series: b = kp E + kd V + sum of cycle[k] t^k, t [s] since the step's start.
struct LawSeries {
  Pack kp, kd;    ///< minus the gains; zero unless aligning
  Pack cycle[6];  ///< zero unless in a cycle
};

/// Taylor coefficients of the velocities about a step's start; the positions are their integrals.
template <int order>
struct Expansion {
  Pack V[order + 1];
  Pack w[order + 1];  ///< of q2_dot
};

/// Expands the closed loop about the state (E, q2, V, w).
template <int order>
[[gnu::noinline, gnu::flatten]] void expand(const LoopConstants<Pack>& loop, const LawSeries& law, Pack E, Pack q2,
                                            Pack V0, Pack w0, Expansion<order>& out) {
  Pack s[order + 1], c[order + 1], S2[order + 1];  // sin q2, cos q2, sin^2 q2
  Pack y[order + 1];
  Pack dV[order], X[order];  // V', V' - ratio b
  Pack(&V)[order + 1] = out.V;
  Pack(&w)[order + 1] = out.w;

  const SinCos<Pack> angle = sincos(q2);
  s[0] = angle.sin;
  c[0] = angle.cos;
  S2[0] = s[0] * s[0];
  V[0] = V0;
  w[0] = w0;
  y[0] = s[0] * w0;

  // V' stands on both sides of its equation; these are the factors once it is solved for.
  const Pack minus_slip = -loop.slip;
  const Pack D = Pack(1.0) / fnma(S2[0], loop.mismatch + loop.belief, Pack(1.0));
  const Pack by_dy = D * loop.mismatch;
  const Pack by_B = by_dy * s[0];
  const Pack by_G = D * loop.belief;
  const Pack by_y = by_G * minus_slip;
  const Pack by_b = fnma(by_G * S2[0], loop.ratio, D * loop.drive);
  const Pack by_V = -(D * loop.damping);
  Pack by_Y = by_dy;

  unroll<0, order>([&]<int n>() {
    constexpr double step = 1.0 / (n + 1);
    Pack b;
    if constexpr (n == 0)
      b = fma(law.kp, E, fma(law.kd, V[0], law.cycle[0]));
    else if constexpr (n < 6)
      b = fma(law.kd, V[n], fma(law.kp, V[n - 1] * Pack(1.0 / n), law.cycle[n]));
    else
      b = fma(law.kd, V[n], law.kp * (V[n - 1] * Pack(1.0 / n)));

    // The convolutions side by side, so that a coefficient is loaded once, and the newest coefficients last.
    Pack B, G, Y, square;  // (sin(q2) V', sin^2(q2) (V' - ratio b) but for the unknown V'[n]; y[n + 1] but for w[n + 1]
    Pack z = c[n] * w[0];  // cos(q2) q2_dot
    unroll<0, n>([&]<int i>() {
      constexpr int k = n - i;
      if constexpr (i == 0) {
        B = s[n] * dV[0];
        Y = s[n] * w[1];
        square = s[n] * s[0];
      } else {
        B = fma(s[k], dV[n - k], B);
        Y = fma(s[k], w[n + 1 - k], Y);
        if constexpr (k > n - k) square = fma(s[k], s[n - k], square);
        if constexpr (i == 1)
          G = S2[k] * X[n - k];
        else
          G = fma(S2[k], X[n - k], G);
      }
      z = fma(c[k - 1], w[n + 1 - k], z);
    });
    if constexpr (n > 0) {
      square = square + square;
      if constexpr (n % 2 == 0) square = fma(s[n / 2], s[n / 2], square);
      S2[n] = square;
      G = n == 1 ? square * X[0] : fma(square, X[0], G);
      B = fma(minus_slip, w[n], B);
    } else {
      B = minus_slip * w[0];
    }
    s[n + 1] = z * Pack(step);
    c[n + 1] = y[n] * Pack(-step);
    if constexpr (n == 0)
      Y = s[1] * w[0];
    else
      Y = fma(s[n + 1], w[0], Y);

    Pack early = fma(by_V, V[n], by_b * b);
    early = fma(by_B, B, early);
    Pack late = by_y * y[n];
    if constexpr (n > 0) late = fma(by_G, G, late);
    const Pack rate = fma(by_Y, Y, early + late);
    by_Y = by_Y + by_dy;
    dV[n] = rate;
    X[n] = fnma(loop.ratio, b, rate);
    V[n + 1] = rate * Pack(step);
    w[n + 1] = fma(s[0], rate, B) * Pack(step);
    y[n + 1] = fma(s[0], w[n + 1], Y);
  });
}

}  // namespace steerstat::STEERSTAT_ISA
