// Between which samples of a step's own polynomials a guard of one lane first fires. Included once by a source
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

/// A function with a guard's sign and roots, as data: position^2 + velocity^2 + offset where `round` is 1, and
/// by_position * position + by_velocity * velocity + offset where it is 0.
///
/// @tparam Cell  double, or Slots
template <class Cell>
struct GuardTerms {
  Cell joint;  ///< 0, or 1: whose motion it watches
  Cell round;
  Cell by_position, by_velocity;
  Cell offset;
};

/// The guard of align: sqrt(E^2 + V^2) - radius.
struct AlignGuard {
  static constexpr int joint = 0;
  double radius;

  [[nodiscard]] Evidence judge(const Samples& s, double slack, double width) const {
    Evidence evidence;
    for (int i = 0; i < Samples::parts; i += Pack::lanes) {
      const Pack E0 = s.position.starts(i), V0 = s.velocity.starts(i);
      const Pack E1 = s.position.ends(i), V1 = s.velocity.ends(i);
      const Pack limit(radius * radius);
      const Mask out0 = limit < fma(E0, E0, V0 * V0);
      const Mask out1 = limit < fma(E1, E1, V1 * V1);
      const Mask quiet = chord_avoids(E0, V0, E1, V1, Pack(radius + slack) + position_slack(V0, V1, slack, width));
      evidence.crossing |= bits(out0 & !out1) << i;
      evidence.uncertain |= bits(out0 & out1 & !quiet) << i;
    }
    return evidence;
  }
  /// A function with the guard's sign and roots.
  [[nodiscard]] double value(double position, double velocity) const {
    return std::fma(position, position, velocity * velocity) - radius * radius;
  }
  [[nodiscard]] GuardTerms<double> terms() const { return {joint, 1.0, 0.0, 0.0, -(radius * radius)}; }
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
      const Pack V0 = s.velocity.starts(i), V1 = s.velocity.ends(i);
      const Pack allowance = fma(Pack(std::abs(kp)), position_slack(V0, V1, slack, width), Pack(std::abs(kd) * slack));
      const Pack g0 = Pack(ceiling) - Pack(sign) * fma(Pack(kp), s.position.starts(i), Pack(kd) * V0);
      const Pack g1 = Pack(ceiling) - Pack(sign) * fma(Pack(kp), s.position.ends(i), Pack(kd) * V1);
      note(g0, g1, allowance, i, evidence);
    }
    return evidence;
  }
  [[nodiscard]] double value(double position, double velocity) const {
    return ceiling - sign * std::fma(kp, position, kd * velocity);
  }
  [[nodiscard]] GuardTerms<double> terms() const { return {joint, 0.0, -sign * kp, -sign * kd, ceiling}; }
};

/// A guard of drift: sign * position - bound, or sign * velocity - bound.
struct DriftGuard {
  static constexpr int joint = 1;
  bool of_velocity;
  double sign;
  double bound;

  [[nodiscard]] Evidence judge(const Samples& s, double slack, double width) const {
    const Samples::Track& watched = of_velocity ? s.velocity : s.position;
    Evidence evidence;
    for (int i = 0; i < Samples::parts; i += Pack::lanes) {
      const Pack allowance =
          of_velocity ? Pack(slack) : position_slack(s.velocity.starts(i), s.velocity.ends(i), slack, width);
      const Pack g0 = Pack(sign) * watched.starts(i) - Pack(bound);
      const Pack g1 = Pack(sign) * watched.ends(i) - Pack(bound);
      note(g0, g1, allowance, i, evidence);
    }
    return evidence;
  }
  [[nodiscard]] double value(double position, double velocity) const {
    return sign * (of_velocity ? velocity : position) - bound;
  }
  [[nodiscard]] GuardTerms<double> terms() const {
    return {joint, 0.0, of_velocity ? 0.0 : sign, of_velocity ? sign : 0.0, -bound};
  }
};

/// Where a guard fires: it is positive at `low` and <= 0 at `high`, or fires at both, which are one.
///
/// @tparam Cell  double, or Slots
template <class Cell>
struct Bracket {
  Cell low, high;      ///< [s] since the step's start
  Cell g_low, g_high;  ///< the guard there
  Cell bend;           ///< its second difference over parts of the bracket's width
};

/// A span narrower than 16^-4 of a step is not searched for dips: what could hide there is below rounding.
inline constexpr int deepest = 3;

/// The guard's first crossing in a span from positive to <= 0, to `out`. @return whether there is one
///
/// @param s      the joint that it watches, in the span
/// @param bend   bound on |second derivative of the velocity| over the step [1/s^2 times its unit]
/// @param armed  whether the guard has been positive before, so that it fires at the span's start if it is <= 0 there
template <class Guard>
[[gnu::noinline]] bool bracket_crossing(const Guard& guard, const SeriesView& joint, const Samples& s, double bend,
                                        bool armed, int depth, Bracket<double>& out) {
  const auto g = [&](int end) { return guard.value(s.position[end], s.velocity[end]); };
  if (armed && g(0) <= 0.0) {
    out = {s.from, s.from, 0.0, 0.0, 0.0};
    return true;
  }
  const double part = s.width / Samples::parts;
  Evidence evidence = guard.judge(s, bend * part * part * 0.125, part);
  if (depth == deepest) evidence.uncertain = 0;
  std::uint32_t suspects = evidence.crossing | evidence.uncertain;
  while (suspects != 0) {
    const int i = std::countr_zero(suspects);
    if ((evidence.crossing >> i & 1) != 0) {
      const double g0 = g(i), g1 = g(i + 1);
      // With the part beside it.
      const double bent = i > 0 ? g(i - 1) - 2.0 * g0 + g1 : g0 - 2.0 * g1 + g(2);
      out = {s.t(i), s.t(i + 1), g0, g1, bent};
      return true;
    }
    Samples closer;
    sample(joint, s.t(i), part, s.position[i], s.velocity[i], closer);
    if (bracket_crossing(guard, joint, closer, bend, false, depth + 1, out)) return true;
    suspects &= suspects - 1;
  }
  return false;
}

}  // namespace steerstat::STEERSTAT_ISA
