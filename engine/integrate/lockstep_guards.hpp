// Where a guard of one lane first fires within a step, on the step's own polynomials. Included once by a source
// compiled for an instruction set, after the motion; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// What a set of samples says of a guard, a bit a part.
struct Evidence {
  std::uint32_t crossing{0};   ///< it goes from positive to <= 0 between the part's ends
  std::uint32_t uncertain{0};  ///< positive at both ends, and it may have dipped between them
};

/// How far a position may stray from its chord over a part: its second derivative, the acceleration, is at most
/// |V1 - V0| / width and what the velocity bends.
///
/// @param V0, V1  the velocity at the part's ends, @param slack  how far it may stray from its own chord
inline Pack position_slack(Pack V0, Pack V1, double slack, double width) {
  return (abs(V1 - V0) + Pack(8.0 * slack)) * Pack(0.125 * width);
}

/// Notes what parts i to i + Pack::lanes - 1 say of a guard.
///
/// @param g0, g1  the guard at their ends, @param allowance  how far it may stray from its chord between them
inline void note(Pack g0, Pack g1, Pack allowance, int i, Evidence& evidence) {
  const Mask positive0 = Pack(0.0) < g0;
  const Mask positive1 = Pack(0.0) < g1;
  evidence.crossing |= bits(positive0 & !positive1) << i;
  evidence.uncertain |= bits(positive0 & positive1 & (min(g0, g1) <= allowance)) << i;
}

/// The guard of align: sqrt(E^2 + V^2) - radius.
struct AlignGuard {
  static constexpr int joint = 0;
  double radius;

  [[nodiscard]] Evidence judge(const Samples& s, double slack, double width) const {
    Evidence evidence;
    for (int i = 0; i < Samples::parts; i += Pack::lanes) {
      const Pack E0 = load(s.before.position + i), V0 = load(s.before.velocity + i);
      const Pack E1 = load(s.after.position + i), V1 = load(s.after.velocity + i);
      const Pack limit(radius * radius);
      const Mask out0 = limit < fma(E0, E0, V0 * V0);
      const Mask out1 = limit < fma(E1, E1, V1 * V1);
      const Mask quiet = chord_avoids(E0, V0, E1, V1, Pack(radius + slack) + position_slack(V0, V1, slack, width));
      evidence.crossing |= bits(out0 & !out1) << i;
      evidence.uncertain |= bits(out0 & out1 & !quiet) << i;
    }
    return evidence;
  }
  /// A function with the guard's sign and roots, and its derivatives.
  [[nodiscard]] double value(double position, double velocity) const {
    return std::fma(position, position, velocity * velocity) - radius * radius;
  }
  [[nodiscard]] double rate(const Motion& m) const { return 2.0 * m.velocity * (m.position + m.acceleration); }
  [[nodiscard]] double curvature(const Motion& m) const {
    return 2.0 * (m.acceleration * (m.position + m.acceleration) + m.velocity * (m.velocity + m.jerk));
  }
};

/// A guard of align: ceiling - sign * (kp * position + kd * velocity).
struct CeilingGuard {
  static constexpr int joint = 0;
  double kp, kd;
  double sign;
  double ceiling;

  [[nodiscard]] Evidence judge(const Samples& s, double slack, double width) const {
    Evidence evidence;
    for (int i = 0; i < Samples::parts; i += Pack::lanes) {
      const Pack V0 = load(s.before.velocity + i), V1 = load(s.after.velocity + i);
      const Pack allowance = fma(Pack(std::abs(kp)), position_slack(V0, V1, slack, width), Pack(std::abs(kd) * slack));
      const Pack g0 = Pack(ceiling) - Pack(sign) * fma(Pack(kp), load(s.before.position + i), Pack(kd) * V0);
      const Pack g1 = Pack(ceiling) - Pack(sign) * fma(Pack(kp), load(s.after.position + i), Pack(kd) * V1);
      note(g0, g1, allowance, i, evidence);
    }
    return evidence;
  }
  [[nodiscard]] double value(double position, double velocity) const {
    return ceiling - sign * std::fma(kp, position, kd * velocity);
  }
  [[nodiscard]] double rate(const Motion& m) const { return -sign * std::fma(kp, m.velocity, kd * m.acceleration); }
  [[nodiscard]] double curvature(const Motion& m) const { return -sign * std::fma(kp, m.acceleration, kd * m.jerk); }
};

/// A guard of drift: sign * position - bound, or sign * velocity - bound.
struct DriftGuard {
  static constexpr int joint = 1;
  bool of_velocity;
  double sign;
  double bound;

  [[nodiscard]] Evidence judge(const Samples& s, double slack, double width) const {
    const double* before = of_velocity ? s.before.velocity : s.before.position;
    const double* after = of_velocity ? s.after.velocity : s.after.position;
    Evidence evidence;
    for (int i = 0; i < Samples::parts; i += Pack::lanes) {
      const Pack allowance =
          of_velocity ? Pack(slack)
                      : position_slack(load(s.before.velocity + i), load(s.after.velocity + i), slack, width);
      const Pack g0 = Pack(sign) * load(before + i) - Pack(bound);
      const Pack g1 = Pack(sign) * load(after + i) - Pack(bound);
      note(g0, g1, allowance, i, evidence);
    }
    return evidence;
  }
  [[nodiscard]] double value(double position, double velocity) const {
    return sign * (of_velocity ? velocity : position) - bound;
  }
  [[nodiscard]] double rate(const Motion& m) const { return sign * (of_velocity ? m.acceleration : m.velocity); }
  [[nodiscard]] double curvature(const Motion& m) const { return sign * (of_velocity ? m.jerk : m.acceleration); }
};

/// Where a guard fires, and the motion there.
struct Crossing {
  double t{Phase::unbounded};  ///< [s] since the step's start; infinite: nowhere
  LaneMotion::Moment near;     ///< a moment next to it, where it fires

  [[nodiscard]] Motion motion(int joint) const { return near.joint[joint].after(t - near.t); }
};

/// The guard's root in (low, high], where it goes from positive to <= 0, to 1e-10 of the part and so to rounding in
/// the state: Halley's method kept in the bracket.
///
/// A guard that turns back may do so next to its root, or rise out of the bracket's end; changes are small there too.
///
/// @param g_low, g_high  the guard at the bracket's ends
/// @param bend           its second difference over parts of the bracket's width, for the first guess
template <class Guard>
[[gnu::noinline]] void refine(const Guard& guard, const LaneMotion& motion, double low, double high, double g_low,
                              double g_high, double bend, Crossing& out) {
  // The parabola through the bracket's ends, by one Newton step from the chord's root; in shares of the width.
  const double width = high - low;
  const double slope = g_high - g_low;
  const double chord = -g_low / slope;
  const double share = chord - 0.5 * bend * chord * (chord - 1.0) / (slope + bend * (chord - 0.5));
  double t = std::fma(0.0 < share && share < 1.0 ? share : chord, width, low);
  for (int i = 0; i < 60; ++i) {
    motion.at(t, out.near);
    const Motion& watched = out.near.joint[Guard::joint];
    const double g = guard.value(watched.position, watched.velocity);
    (g > 0.0 ? low : high) = t;
    const double rate = guard.rate(watched), bent = g * guard.curvature(watched);
    const double change = 2.0 * g * rate / (2.0 * rate * rate - bent);
    double next = t - change;
    // Convergence is cubic: what is left after a change this small is 1e-8 of the part, times how curved it is,
    // squared.
    const bool falls = rate < 0.0 && std::abs(bent) <= rate * rate;
    if (falls && std::abs(change) <= 2e-3 * width) {
      out.t = std::clamp(next, low, high);
      return;
    }
    if (!(low < next && next < high)) {
      next = 0.5 * (low + high);
      if (!(low < next && next < high)) break;
    }
    t = next;
  }
  out.t = high;
  motion.at(high, out.near);
}

/// A span narrower than 16^-4 of a step is not searched for dips: what could hide there is below rounding.
inline constexpr int deepest = 3;

/// The guard's first crossing in (from, from + width] from positive to <= 0, to `out`; where there is none, nothing.
///
/// @param s      the watched joint there
/// @param bend   bound on |second derivative of the velocity| over the step [1/s^2 times its unit]
/// @param armed  whether the guard has been positive before, so that it fires at `from` if it is <= 0 there
template <class Guard>
[[gnu::noinline]] void first_crossing(const Guard& guard, const LaneMotion& motion, const Samples& s, double from,
                                      double width, double bend, bool armed, int depth, Crossing& out) {
  if (armed && guard.value(s.before.position[0], s.before.velocity[0]) <= 0.0) {
    out.t = from;
    motion.at(from, out.near);
    return;
  }
  const double part = width / Samples::parts;
  Evidence evidence = guard.judge(s, bend * part * part * 0.125, part);
  if (depth == deepest) evidence.uncertain = 0;
  std::uint32_t suspects = evidence.crossing | evidence.uncertain;
  while (suspects != 0) {
    const int i = std::countr_zero(suspects);
    if ((evidence.crossing >> i & 1) != 0) {
      const double g0 = guard.value(s.before.position[i], s.before.velocity[i]);
      const double g1 = guard.value(s.after.position[i], s.after.velocity[i]);
      const int m = i > 0 ? i - 1 : 1;  // the part beside it
      const double g2 = i > 0 ? guard.value(s.before.position[m], s.before.velocity[m])
                              : guard.value(s.after.position[m], s.after.velocity[m]);
      const double second = i > 0 ? g2 - 2.0 * g0 + g1 : g0 - 2.0 * g1 + g2;
      refine(guard, motion, s.before.t[i], s.after.t[i], g0, g1, second, out);
      return;
    }
    Samples closer;
    sample(motion.joint[Guard::joint], s.before.t[i], part, closer);
    first_crossing(guard, motion, closer, s.before.t[i], part, bend, false, depth + 1, out);
    if (out.t < Phase::unbounded) return;
    suspects &= suspects - 1;
  }
}

/// Where a guard of the lane's phase first fires within its last step.
///
/// @param armed  whether its guards have all been positive before
[[gnu::noinline]] inline void locate_guard(const LaneRows& lanes, int lane, const LaneMotion& motion, bool armed,
                                           Crossing& out) {
  const double h = lanes.h[lane];
  const double bend = lanes.bend[lane] / (h * h);
  const bool aligning = lanes.radius[lane] >= 0.0;
  Samples samples;
  sample(motion.joint[aligning ? 0 : 1], 0.0, h, samples);
  const auto consider = [&](const auto& guard, double bound) {
    if (!(std::abs(bound) < Phase::unbounded)) return;
    Crossing crossing;
    first_crossing(guard, motion, samples, 0.0, h, bend, armed, 0, crossing);
    if (crossing.t < out.t) out = crossing;
  };
  if (aligning) {
    first_crossing(AlignGuard{lanes.radius[lane]}, motion, samples, 0.0, h, bend, armed, 0, out);
    const double kp = lanes.kp[lane], kd = lanes.kd[lane], ceiling = lanes.ceiling[lane];
    consider(CeilingGuard{kp, kd, 1.0, ceiling}, ceiling);
    consider(CeilingGuard{kp, kd, -1.0, ceiling}, ceiling);
    return;
  }
  const auto consider_drift = [&](const DriftGuard& guard) { consider(guard, guard.bound); };
  consider_drift({false, 1.0, lanes.q2_low[lane]});
  consider_drift({false, -1.0, -lanes.q2_high[lane]});
  consider_drift({true, lanes.direction[lane], lanes.speed_floor[lane]});
}

}  // namespace steerstat::STEERSTAT_ISA
