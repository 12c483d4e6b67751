// The Taylor series of a closed loop with imperfections, a pack of trials at a time. Included once by a source compiled
// for an instruction set, after the series of one without; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// What the closed loop of a trial with imperfections is made of: (1)-(2) of the true plant under (R1)-(R3).
///
/// In the coordinates of LoopConstants, with the force asked for as what it adds to V', D = K gain tau / (m1 + m2),
/// and T the same of the force applied,
///     D = drive b - belief_b sin^2(q2) b - belief cos(q2) q2_dot^2
///     T = D within the limit, else the limit with D's sign
///     V' = pull (sin(q2) q2_ddot + cos(q2) q2_dot^2) + T + fall - damping V - rub1 share(V sharp1)
///     q2_ddot = sin(q2) (V' - fall) + tilt cos(q2) - slip q2_dot - rub2 share(q2_dot sharp2)
/// share being (R2) with a smoothing velocity of 1.
template <class Real>
struct ImperfectConstants {
  Real slip, damping;   ///< [1/s] as in LoopConstants
  Real pull;            ///< K m2 d2 / (m1 + m2)
  Real drive;           ///< gain nominal (m1 + m2) / (m1 + m2)
  Real belief;          ///< K gain nominal m2 d2 / (m1 + m2)
  Real belief_b;        ///< gain nominal (m2 d2)^2 / (I2 + m2 d2^2) / (m1 + m2)
  Real limit;           ///< |K| max_force / (m1 + m2), per s^2; infinite without a limit
  Real fall, tilt;      ///< K gravity_x and K gravity_y, per s^2
  Real rub1, rub2;      ///< |K| coulomb1 / (m1 + m2) and coulomb2 / (I2 + m2 d2^2), per s^2
  Real sharp1, sharp2;  ///< 1 / (|K| coulomb_speed1) and 1 / coulomb_speed2, s
};

/// Where the force applied stands to the force asked for; a lane's mode.
inline constexpr double at_lower_limit = -1.0;
inline constexpr double within_limits = 0.0;
inline constexpr double at_upper_limit = 1.0;
inline constexpr double undecided = 2.0;  ///< a phase begins: its first expansion decides

/// Taylor coefficients about a step's start.
struct ImperfectExpansion {
  Pack V[order + 1], w[order + 1];  ///< of the velocities; the positions are their integrals
  Pack D[order];                    ///< of the force asked for
  Pack mode;                        ///< of the step
};

/// The coefficients of share(x) = x / sqrt(x^2 + 1), one after the other.
///
/// With u = x^2 + 1, r = u^(-1/2) fulfils u r' = -u' r / 2, whence [Knuth 1997, 4.7]
///     n u[0] r[n] = sum over k = 1 ... n of (k / 2 - n) u[k] r[n - k].
struct ShareSeries {
  Pack x[order], u[order], r[order];
  Pack reciprocal;  // 1 / u[0]

  /// @param coefficient  x[n]; those before it have been given. @return the share's coefficient n
  Pack extend(int n, Pack coefficient) {
    x[n] = coefficient;
    Pack square = x[0] * x[n];
    for (int k = 1; k <= n; ++k) square = fma(x[k], x[n - k], square);
    if (n == 0) {
      u[0] = square + Pack(1.0);
      reciprocal = Pack(1.0) / u[0];
      r[0] = sqrt(reciprocal);
      return x[0] * r[0];
    }
    u[n] = square;
    Pack sum(0.0);
    Pack share = x[n] * r[0];
    for (int k = 1; k <= n; ++k) {
      sum = fma(Pack(0.5 * k / n - 1.0) * u[k], r[n - k], sum);
      if (k < n) share = fma(x[n - k], r[k], share);
    }
    r[n] = sum * reciprocal;
    return fma(x[0], r[n], share);
  }
};

/// Expands the closed loop about the state (E, q2, V, w), which is in the series' units of time, as `loop` and `law`
/// are. Straightforward where the series without imperfections is fast.
///
/// @tparam rubs   whether a lane has Coulomb friction; the bits of the others do not depend on it
/// @param read_V  what the law reads of V, less V
/// @param mode    of each lane
template <bool rubs>
[[gnu::noinline]] void expand(const ImperfectConstants<Pack>& loop, const LawSeries& law, Pack read_V, Pack E, Pack q2,
                              Pack V0, Pack w0, Pack mode, ImperfectExpansion& out) {
  auto& [V, w, D, decided] = out;
  Pack s[order + 1], c[order + 1];
  Pack b[order], square[order], z[order], dV[order], dw[order];  // square: sin^2(q2), z: cos(q2) q2_dot
  const SinCos<Pack> angle = sincos(q2);
  s[0] = angle.sin;
  c[0] = angle.cos;
  V[0] = V0;
  w[0] = w0;
  ShareSeries share1, share2;
  const Mask rubs1 = Pack(0.0) < loop.rub1, rubs2 = Pack(0.0) < loop.rub2;
  const Pack D_V = Pack(1.0) / fnma(loop.pull * s[0], s[0], Pack(1.0));
  Mask saturated = Pack(0.0) < Pack(0.0);
  for (int n = 0; n < order; ++n) {
    b[n] = n == 0 ? fma(law.kd, V[0] + read_V, law.kp * E) : fma(law.kd, V[n], law.kp * (V[n - 1] * Pack(1.0 / n)));
    if (n < 6) b[n] = b[n] + law.cycle[n];

    Pack sine_w = s[0] * w[n];
    Pack cosine_w = c[0] * w[n];
    Pack sine_sine = s[0] * s[n];
    Pack sine_dV(0.0), sine_dw(0.0), centrifugal(0.0), square_b(0.0);
    for (int k = 1; k <= n; ++k) {
      sine_w = fma(s[k], w[n - k], sine_w);
      cosine_w = fma(c[k], w[n - k], cosine_w);
      sine_sine = fma(s[k], s[n - k], sine_sine);
      sine_dV = fma(s[k], dV[n - k], sine_dV);
      sine_dw = fma(s[k], dw[n - k], sine_dw);
      centrifugal = fma(z[n - k], w[k], centrifugal);
      square_b = fma(square[n - k], b[k], square_b);
    }
    z[n] = cosine_w;
    square[n] = sine_sine;
    centrifugal = fma(z[n], w[0], centrifugal);
    square_b = fma(square[n], b[0], square_b);

    D[n] = fnma(loop.belief, centrifugal, fnma(loop.belief_b, square_b, loop.drive * b[n]));
    Pack T = D[n];
    if (n == 0) {
      const Pack upper = select(loop.limit < D[0], Pack(at_upper_limit), Pack(within_limits));
      const Pack initial = select(D[0] < -loop.limit, Pack(at_lower_limit), upper);
      decided = select(mode == Pack(undecided), initial, mode);
      saturated = Pack(0.0) < abs(decided);
      T = select(saturated, select(Pack(0.0) < decided, loop.limit, -loop.limit), T);
    } else {
      T = select(saturated, Pack(0.0), T);
    }

    Pack force = fnma(loop.damping, V[n], T);                                      // on the first joint, as part of V'
    Pack torque = fnma(loop.slip, w[n], fnma(loop.fall, s[n], loop.tilt * c[n]));  // on the second, of q2_ddot
    if (n == 0) force = force + loop.fall;
    if constexpr (rubs) {
      force = fnma(loop.rub1, select(rubs1, share1.extend(n, V[n] * loop.sharp1), Pack(0.0)), force);
      torque = fnma(loop.rub2, select(rubs2, share2.extend(n, w[n] * loop.sharp2), Pack(0.0)), torque);
    }
    torque = torque + sine_dV;
    const Pack inertial = fma(s[0], torque, sine_dw) + centrifugal;
    dV[n] = fma(loop.pull, inertial, force) * D_V;
    dw[n] = fma(s[0], dV[n], torque);
    const Pack step(1.0 / (n + 1));
    V[n + 1] = dV[n] * step;
    w[n + 1] = dw[n] * step;
    s[n + 1] = cosine_w * step;
    c[n + 1] = -(sine_w * step);
  }
}

}  // namespace steerstat::STEERSTAT_ISA
