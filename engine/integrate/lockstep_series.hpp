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

/// Order of the Taylor series of the velocities.
inline constexpr int order = 13;

/// The precision of an expansion: how many coefficients are in double precision, the rest being in single.
///
/// A step's k-th term is about the (k / order)-th power of its tolerance. From the seventh on single precision's
/// rounding, 2^-24 of them, is below what a step of the default tolerance truncates (with one more in double the error
/// of a settling time falls by 3 %), and twice as many trials are advanced by an instruction; finer tolerances need
/// double throughout.
inline constexpr int mixed = 7;
inline constexpr int full = order + 1;

/// What the closed loop of a trial is made of: (1)-(2) of the true plant under the linearising force of the nominal
/// one.
///
/// The first joint is scaled by the true coupling K: E = K (q1 - q1_goal), V = K q1_dot, b = K a. With
/// y = sin(q2) q2_dot, whose derivative collects the centrifugal terms and the inertia coupling of both equations,
///     V' = mismatch y' + drive b - damping V + belief (sin^2(q2) (V' - ratio b) - slip y)
///     q2_ddot = sin(q2) V' - slip q2_dot
/// which takes four and a half convolutions an order and no division of series.
///
/// The series runs in units of time of its own, a power of two near the step, so that its coefficients are of the size
/// of its terms; rates are then per that unit.
template <class Real>
struct LoopConstants {
  Real slip;      ///< [1/s] f2 / (I2 + m2 d2^2)
  Real mismatch;  ///< K (true - nominal m2 d2) / (m1 + m2)
  Real drive;     ///< nominal (m1 + m2) / (m1 + m2)
  Real damping;   ///< [1/s] f1 / (m1 + m2)
  Real belief;    ///< K nominal m2 d2 / (m1 + m2)
  Real ratio;     ///< K nominal / K
};

/// The law for b as a series: b = kp E + kd V + sum of cycle[k] t^k, t since the step's start.
struct LawSeries {
  Pack kp, kd;    ///< minus the gains; zero unless aligning
  Pack cycle[6];  ///< zero unless in a cycle
};

/// Taylor coefficients of the velocities about a step's start; the positions are their integrals.
template <int precision>
struct Expansion {
  Pack V[precision], w[precision];                ///< the first, in double precision
  Single V_short[order + 1], w_short[order + 1];  ///< all, in single precision
};

/// Taylor coefficients of the force on the first joint about a step's start, as K tau / (m1 + m2). By (1) of the true
/// plant it is V' - K m2 d2 / (m1 + m2) y' + damping V, so it has a coefficient fewer than the velocities.
template <int precision>
struct ForceSeries {
  static constexpr int wide = precision - 1;
  Pack F[wide];                                     ///< the first, in double precision
  Single F_short[order > wide ? order - wide : 1];  ///< the others, in single precision
};

/// In a ForceSeries' place where nobody asks for the force.
struct NoForceSeries {};

/// The recurrence for the coefficients, in either precision.
///
/// What an order waits for is V'[n - 1] of the order before: the sums are arranged so that four operations, one after
/// the other, lead from there to V'[n], by way of w, z and Y.
template <class Real>
struct Recurrence {
  Real E, minus_slip, ratio, kp, kd;
  // V' stands on both sides of its equation; these are the factors once it is solved for.
  Real by_dy, by_Y, by_B, by_w, by_G, by_X, by_y, by_b, by_V;
  Real s[order + 1], c[order + 1], S2[order];  // sin q2, cos q2, sin^2 q2
  Real y[order + 1], V[order + 1], w[order + 1];
  Real dV[order], X[order];  // V', V' - ratio b

  /// From the coefficients up to n, those of n + 1.
  template <int n>
  [[gnu::always_inline]] void extend(const Pack (&cycle)[6]) {
    constexpr double step = 1.0 / (n + 1);
    Real b;
    if constexpr (n < 6) {
      static_assert(mixed > 6, "the cycle's polynomial is in double precision");
      if constexpr (n == 0)
        b = fma(kd, V[0], fma(kp, E, cycle[0]));
      else
        b = fma(kd, V[n], fma(kp, V[n - 1] * Real(1.0 / n), cycle[n]));
    } else {
      b = fma(kd, V[n], kp * (V[n - 1] * Real(1.0 / n)));
    }

    // The convolutions side by side, so that a coefficient is loaded once, and from the middle outwards, so that the
    // newest coefficients, at both ends, are waited for last.
    Real B, G, Y, z,
        square;  // sin(q2) V', sin^2(q2) (V' - ratio b) but for V'[n]; y[n + 1] but for w[n + 1] and s[n + 1]
    unroll<0, n>([&]<int i>() __attribute__((always_inline)) {
      constexpr int k = (n + 1) / 2 + (i % 2 == 1 ? (i + 1) / 2 : -(i / 2));
      B = i == 0 ? s[k] * dV[n - k] : fma(s[k], dV[n - k], B);
      Y = i == 0 ? s[k] * w[n + 1 - k] : fma(s[k], w[n + 1 - k], Y);
      z = i == 0 ? c[k - 1] * w[n + 1 - k] : fma(c[k - 1], w[n + 1 - k], z);
      if constexpr (1 < k && k < n) G = i == 0 ? S2[k] * X[n - k] : fma(S2[k], X[n - k], G);
      if constexpr (2 * k > n) square = i == 1 - n % 2 ? s[k] * s[n - k] : fma(s[k], s[n - k], square);
    });
    z = n == 0 ? c[0] * w[0] : fma(c[n], w[0], z);
    Real early = fma(by_V, V[n], by_w * w[n]);
    Real late = by_y * y[n];
    if constexpr (n > 0) {
      square = square + square;
      if constexpr (n % 2 == 0) square = fma(s[n / 2], s[n / 2], square);
      S2[n] = square;
      if constexpr (n > 1) {
        G = n == 2 ? square * X[0] : fma(square, X[0], G);
        late = fma(by_X, X[n - 1], fma(by_G, G, late));  // by_X = by_G S2[1]
      } else {
        by_X = by_G * square;
        late = fma(by_X, X[0], late);
      }
      early = fma(by_B, B, early);
    }
    early = fma(by_b, b, early);
    Y = n == 0 ? z * w[0] : fma(z, w[0] * Real(step), Y);  // the term of s[n + 1] = z step
    const Real rate = fma(by_Y, Y, early + late);
    by_Y = by_Y + by_dy;
    s[n + 1] = z * Real(step);
    c[n + 1] = y[n] * Real(-step);
    dV[n] = rate;
    X[n] = fnma(ratio, b, rate);
    V[n + 1] = rate * Real(step);
    B = n == 0 ? minus_slip * w[0] : fma(minus_slip, w[n], B);
    w[n + 1] = fma(s[0] * Real(step), rate, B * Real(step));
    y[n + 1] = fma(s[0], w[n + 1], Y);
  }
};

/// The recurrence in single precision, from where one in double precision has come.
[[gnu::always_inline]] inline void shorten(const Recurrence<Pack>& from, Recurrence<Single>& to) {
  to.minus_slip = narrow(from.minus_slip);
  to.ratio = narrow(from.ratio);
  to.kp = narrow(from.kp);
  to.kd = narrow(from.kd);
  to.by_dy = narrow(from.by_dy);
  to.by_Y = narrow(from.by_Y);
  to.by_B = narrow(from.by_B);
  to.by_w = narrow(from.by_w);
  to.by_X = narrow(from.by_X);
  to.by_G = narrow(from.by_G);
  to.by_y = narrow(from.by_y);
  to.by_b = narrow(from.by_b);
  to.by_V = narrow(from.by_V);
  constexpr int n = mixed - 1;
  unroll<0, n + 1>([&]<int k>() __attribute__((always_inline)) {
    to.s[k] = narrow(from.s[k]);
    to.c[k] = narrow(from.c[k]);
    to.V[k] = narrow(from.V[k]);
    to.w[k] = narrow(from.w[k]);
  });
  unroll<0, n>([&]<int k>() __attribute__((always_inline)) {
    if constexpr (k > 0) to.S2[k] = narrow(from.S2[k]);
    to.dV[k] = narrow(from.dV[k]);
    to.X[k] = narrow(from.X[k]);
  });
  to.y[n] = narrow(from.y[n]);
}

/// Expands the closed loop about the state (E, q2, V, w).
///
/// @param force  a ForceSeries, or a NoForceSeries
template <int precision, class Force>
[[gnu::noinline, gnu::flatten]] void expand(const LoopConstants<Pack>& loop, const LawSeries& law, Pack E, Pack q2,
                                            Pack V, Pack w, Expansion<precision>& out, Force& force) {
  constexpr bool measured = !std::is_same_v<Force, NoForceSeries>;
  const Pack pull = loop.mismatch + loop.belief;
  Recurrence<Pack> r;
  const SinCos<Pack> angle = sincos(q2);
  r.s[0] = angle.sin;
  r.c[0] = angle.cos;
  r.S2[0] = r.s[0] * r.s[0];
  r.E = E;
  r.V[0] = V;
  r.w[0] = w;
  r.y[0] = r.s[0] * w;
  r.minus_slip = -loop.slip;
  r.ratio = loop.ratio;
  r.kp = law.kp;
  r.kd = law.kd;
  const Pack D = Pack(1.0) / fnma(r.S2[0], pull, Pack(1.0));
  r.by_dy = D * loop.mismatch;
  r.by_Y = r.by_dy;
  r.by_B = r.by_dy * r.s[0];
  r.by_w = r.by_B * r.minus_slip;
  r.by_G = D * loop.belief;
  r.by_y = r.by_G * r.minus_slip;
  r.by_b = fnma(r.by_G * r.S2[0], loop.ratio, D * loop.drive);
  r.by_V = -(D * loop.damping);
  Pack by_slope = pull;
  unroll<0, precision - 1>([&]<int n>() __attribute__((always_inline)) {
    r.template extend<n>(law.cycle);
    if constexpr (measured) {
      force.F[n] = fnma(by_slope, r.y[n + 1], fma(loop.damping, r.V[n], r.dV[n]));
      by_slope = by_slope + pull;
    }
  });
  unroll<0, precision>([&]<int k>() __attribute__((always_inline)) {
    out.V[k] = r.V[k];
    out.w[k] = r.w[k];
  });

  if constexpr (precision == full) {
    unroll<0, full>([&]<int k>() __attribute__((always_inline)) {
      out.V_short[k] = narrow(r.V[k]);
      out.w_short[k] = narrow(r.w[k]);
    });
  } else {
    Recurrence<Single> tail;
    shorten(r, tail);
    const Single pull_short = narrow(pull), damping = narrow(loop.damping);
    Single by_slope_short = narrow(by_slope);
    unroll<precision - 1, order>([&]<int n>() __attribute__((always_inline)) {
      tail.template extend<n>(law.cycle);
      if constexpr (measured) {
        force.F_short[n - force.wide] = fnma(by_slope_short, tail.y[n + 1], fma(damping, tail.V[n], tail.dV[n]));
        by_slope_short = by_slope_short + pull_short;
      }
    });
    unroll<0, order + 1>([&]<int k>() __attribute__((always_inline)) {
      out.V_short[k] = tail.V[k];
      out.w_short[k] = tail.w[k];
    });
  }
}

/// The same where nobody asks for the force.
template <int precision>
[[gnu::always_inline]] inline void expand(const LoopConstants<Pack>& loop, const LawSeries& law, Pack E, Pack q2,
                                          Pack V, Pack w, Expansion<precision>& out) {
  NoForceSeries nobody_asks;
  expand(loop, law, E, q2, V, w, out, nobody_asks);
}

}  // namespace steerstat::STEERSTAT_ISA
