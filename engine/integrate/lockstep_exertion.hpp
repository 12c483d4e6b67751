// What a step asks of the first joint, a pack of trials at a time. Included once by a source compiled for an
// instruction set, after the guards; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// What the packs' measure of a step leaves open, a bit a lane.
struct Open {
  std::uint32_t acceleration, force, stroke;  ///< a peak that the step's ends do not show may hide inside
  std::uint32_t unresolved;                   ///< the force's series does not tell the force over so long a step
};

/// The force at x, in the series' units of time.
template <int precision>
[[gnu::always_inline]] inline Pack force_at(const ForceSeries<precision>& series, Pack x) {
  constexpr int wide = ForceSeries<precision>::wide;
  Pack sum(0.0);
  if constexpr (wide < order) {
    const Single x_short = narrow(x);
    Single tail = series.F_short[order - wide - 1];
    unroll<0, order - wide - 1>([&]<int i>() __attribute__((always_inline)) {
      tail = fma(tail, x_short, series.F_short[order - wide - 2 - i]);
    });
    sum = widen(tail);
  }
  unroll<0, wide>([&]<int i>() __attribute__((always_inline)) {
    constexpr int k = wide - 1 - i;
    sum = k == order - 1 ? series.F[k] : fma(sum, x, series.F[k]);
  });
  return sum;
}

// Bounds on x^2 |second derivative| over [0, x] of a series, roundings included: k (k - 1) <= 6 2^(k - 3) from k = 3
// on, with equality where it matters, so that Horner's scheme in 2 x takes no factors.
inline constexpr double bend_rounding = 1.0 + 1e-5;

/// How the force's series behaves over [0, x].
struct ForceBounds {
  Pack bend;   ///< on x^2 |second derivative|
  Pack upper;  ///< on the sum of the terms from the fourth power on
  Pack last;   ///< the last two terms together
};

template <int precision>
[[gnu::always_inline]] inline ForceBounds bound_force(const ForceSeries<precision>& series, Pack x, Single x_short) {
  constexpr int wide = ForceSeries<precision>::wide;
  const Pack twice = x + x, square = x * x;
  const Pack fourth = square * square;
  Pack sum(0.0), last(0.0);
  if constexpr (wide < order) {
    const Single twice_short = x_short + x_short;
    const auto size = [&](int k) { return abs(series.F_short[k - wide]); };
    Single tail = size(order - 1);
    last = widen(fma(tail, x_short, size(order - 2)));
    unroll<0, order - wide - 1>([&]<int i>() __attribute__((always_inline)) {
      tail = fma(tail, twice_short, size(order - 2 - i));
    });
    sum = widen(tail);
  } else {
    last = fma(abs(series.F[order - 1]), x, abs(series.F[order - 2]));
  }
  Pack upper(0.0);
  unroll<0, wide - 3>([&]<int i>() __attribute__((always_inline)) {
    constexpr int k = wide - 1 - i;
    sum = k == order - 1 ? abs(series.F[k]) : fma(sum, twice, abs(series.F[k]));
    if constexpr (k == 4) upper = sum * fourth;
  });
  const Pack bend = fma(sum * Pack(1.5), twice, abs(series.F[2])) * (square * Pack(2.0 * bend_rounding));
  static_assert(order == 13, "the power below");
  return {bend, upper, last * (fourth * fourth) * (square * x)};
}

[[gnu::always_inline]] inline Single bound_velocity_bend(const Single (&V)[order + 1], Single x) {
  const Single twice = x + x;
  Single sum = abs(V[order]);
  unroll<0, order - 3>([&]<int i>() __attribute__((always_inline)) { sum = fma(sum, twice, abs(V[order - 1 - i])); });
  return fma(sum * Single(1.5), twice, abs(V[2])) * (x * x * Single(2.0 * bend_rounding));
}

/// Lobatto's rule on [0, 1]: the ends, which are peaks' first candidates too, and four nodes between. Exact for the
/// square of a force of degree 4; of a smooth one it misses 2e-6 of what the terms of degree 10 amount to.
inline constexpr int nodes = 4;
inline constexpr double node_places[nodes]{0.11747233803526763, 0.35738424175967748, 0.64261575824032252,
                                           0.88252766196473237};
inline constexpr double node_weights[nodes]{0.18923747814892349, 0.27742918851774318, 0.27742918851774318,
                                            0.18923747814892349};
inline constexpr double end_weight = 1.0 / 30;
inline constexpr double end_gap = node_places[0];
inline constexpr double widest_gap = node_places[2] - node_places[1];

/// What the rule may miss of the effort, and what it misses of the square of the terms from the fourth power on.
inline constexpr double effort_precision = 1e-8;
inline constexpr double rule_error = 2e-6;

/// How large the last two terms of the force's series may be beside its peak: what follows them is smaller.
inline constexpr double force_precision = 1e-7;

/// Peaks closer than this to the one known are taken for it.
inline constexpr double same_peak = 1.0 + 1e-8;

/// Measures what is `done` of the last step of every lane, but for what it leaves open.
///
/// Between two samples a gap apart, a function stays within gap^2 max|f''| / 8 of their chord, and has no summit where
/// they differ by gap^2 max|f''| / 2 or more.
template <int precision>
[[gnu::noinline, gnu::flatten]] Open measure(MeasuredLanes<precision>& lanes) {
  const Pack done = load(lanes.done), rate = load(lanes.rate_start);
  const Mask moved = Pack(0.0) < done;
  const Pack x = done * rate;
  const Single x_short = narrow(x);

  // Force: its square's integral, and the largest of its samples.
  const Pack newtons = load(lanes.force_unit) * (rate * rate);
  const Pack F0 = abs(lanes.force.F[0]), F1 = abs(force_at(lanes.force, x));
  Pack squares = fma(F0, F0, F1 * F1) * Pack(end_weight);
  Pack inner(0.0), first(0.0), last(0.0);
  unroll<0, nodes>([&]<int i>() __attribute__((always_inline)) {
    const Pack F = abs(force_at(lanes.force, x * Pack(node_places[i])));
    squares = fma(F * F, Pack(node_weights[i]), squares);
    inner = i == 0 ? F : max(inner, F);
    if constexpr (i == 0) first = F;
    last = F;
  });
  const Pack effort = load(lanes.effort), force = load(lanes.peak_force);
  const auto [force_bend, force_upper, force_last] = bound_force(lanes.force, x, x_short);
  const Pack force_known = max(max(F0, F1) * newtons, force);
  const Pack force_limit = force_known * Pack(same_peak);
  const auto may_exceed = [&](Pack samples, double gap) {
    return force_limit < fma(force_bend, Pack(gap * gap / 8), samples) * newtons;
  };
  const Pack steep = force_bend * Pack(end_gap * end_gap / 2);
  const Mask hidden_force = may_exceed(inner, widest_gap) | (may_exceed(F0, end_gap) & (F0 - first < steep)) |
                            (may_exceed(F1, end_gap) & (F1 - last < steep));
  const Pack effort_now = fma(done * squares, newtons * newtons, effort);
  const Pack missed = force_upper * newtons;
  const Mask unresolved = (force_known * Pack(force_precision) < force_last * newtons) |
                          (effort_now * Pack(effort_precision) < missed * missed * (done * Pack(rule_error)));
  const Mask resolved = moved & !unresolved;
  store(lanes.effort, select(resolved, effort_now, effort));
  store(lanes.peak_force, select(resolved, force_known, force));

  // Stroke: the first joint has a summit where it turns round.
  const Pack metres = load(lanes.scale);
  const Pack E_start = load(lanes.E_start), E_end = load(lanes.E);
  const Pack V_start = lanes.series.V[0] * rate, V_end = load(lanes.V);
  const Single V_bend_short = bound_velocity_bend(lanes.series.V_short, x_short);
  const Pack V_bend = widen(V_bend_short) * rate;
  const Pack E_bend = widen(fma(abs(lanes.series.V_short[1]), x_short, V_bend_short) * x_short);
  const Pack stroke = load(lanes.peak_stroke);
  const Pack E_most = max(abs(E_start), abs(E_end));
  const Pack stroke_known = max(E_most * metres, stroke);
  const Pack slack = V_bend * Pack(1.0 / 8);
  const Mask one_way = (slack < min(V_start, V_end)) | (max(V_start, V_end) < -slack);
  const Mask hidden_stroke = !one_way & (stroke_known * Pack(same_peak) < fma(E_bend, Pack(1.0 / 8), E_most) * metres);
  store(lanes.peak_stroke, select(moved, stroke_known, stroke));

  // Acceleration: align's law; a cycle's is known beforehand.
  const Pack kp = load(lanes.kp), kd = load(lanes.kd);
  const Pack b_start = fma(kp, E_start, kd * V_start), b_end = fma(kp, E_end, kd * V_end);
  const Pack b_bend = fma(abs(kp), E_bend, abs(kd) * V_bend);
  const Pack acceleration = load(lanes.peak_acceleration);
  const Pack b_most = max(abs(b_start), abs(b_end));
  const Pack acceleration_known = max(b_most * metres, acceleration);
  const Mask hidden_acceleration = (abs(b_end - b_start) < b_bend * Pack(0.5)) &
                                   (acceleration_known * Pack(same_peak) < fma(b_bend, Pack(1.0 / 8), b_most) * metres);
  store(lanes.peak_acceleration, select(moved, acceleration_known, acceleration));

  return {bits(hidden_acceleration & moved), bits(hidden_force & resolved), bits(hidden_stroke & moved),
          bits(moved & unresolved)};
}

/// A function of one lane over its last step: a polynomial in the series' units of time.
struct LanePolynomial {
  static constexpr int terms = order + 2;
  double p[terms];
};

/// The largest |value| of a polynomial where it is level within (0, x_end); 0 where it is nowhere. What turns back
/// within an eighth of the step is not seen.
[[gnu::noinline]] inline double highest_summit(const LanePolynomial& f, double x_end) {
  constexpr int terms = LanePolynomial::terms;
  const auto& p = f.p;
  // The starts of eight parts, and their ends.
  alignas(64) static constexpr double places[16] = {0.0,     1.0 / 8, 2.0 / 8, 3.0 / 8, 4.0 / 8, 5.0 / 8,
                                                    6.0 / 8, 7.0 / 8, 1.0 / 8, 2.0 / 8, 3.0 / 8, 4.0 / 8,
                                                    5.0 / 8, 6.0 / 8, 7.0 / 8, 1.0};
  alignas(64) double slopes[16];
  std::uint32_t rising = 0;
  for (int i = 0; i < 16; i += Pack::lanes) {
    const Pack x = load(places + i) * Pack(x_end);
    Pack slope((terms - 1) * p[terms - 1]);
    for (int k = terms - 2; k > 0; --k) slope = fma(slope, x, Pack(k * p[k]));
    rising |= bits(Pack(0.0) < slope) << i;
    store(slopes + i, slope);
  }
  double highest = 0.0;
  for (std::uint32_t turning = (rising ^ rising >> 8) & 0xff; turning != 0; turning &= turning - 1) {
    const int i = std::countr_zero(turning);
    const double s0 = slopes[i], s1 = slopes[i + 8];
    const double x = std::fma(s0 / (s0 - s1), 1.0 / 8, places[i]) * x_end;
    double value = p[terms - 1], slope = 0.0, half_bend = 0.0;
    for (int k = terms - 2; k >= 0; --k) {
      half_bend = std::fma(half_bend, x, slope);
      slope = std::fma(slope, x, value);
      value = std::fma(value, x, p[k]);
    }
    // From the chord's root to the parabola's summit.
    const double rise = slope * slope / (4.0 * half_bend);
    const double summit = std::abs(rise) <= 1e-2 * std::abs(value) ? value - rise : value;
    highest = std::max(highest, std::abs(summit));
  }
  return highest;
}

/// One lane's force over its last step.
template <int precision>
[[gnu::noinline]] void force_of(const MeasuredLanes<precision>& lanes, int lane, LanePolynomial& out) {
  constexpr int wide = ForceSeries<precision>::wide;
  const auto* doubles = reinterpret_cast<const char*>(lanes.force.F) + static_cast<std::size_t>(lane) * sizeof(double);
  const auto* floats =
      reinterpret_cast<const char*>(lanes.force.F_short) + static_cast<std::size_t>(lane) * sizeof(float);
  for (std::size_t k = 0; k < LanePolynomial::terms; ++k) {
    float coefficient = 0.0f;
    if (k < wide) {
      std::memcpy(&out.p[k], doubles + k * sizeof(Pack), sizeof(double));
      continue;
    }
    if (k < order) std::memcpy(&coefficient, floats + (k - wide) * sizeof(Single), sizeof(float));
    out.p[k] = static_cast<double>(coefficient);
  }
}

/// One lane's E over its last step.
template <int precision>
[[gnu::noinline]] void stroke_of(const MeasuredLanes<precision>& lanes, int lane, LanePolynomial& out) {
  double V[order + 1];
  take_lane(lanes.series.V, lanes.series.V_short, lane, V);
  out.p[0] = lanes.E_start[lane];
  for (int k = 0; k <= order; ++k) out.p[k + 1] = V[k] * reciprocals[static_cast<std::size_t>(k) + 1];
}

/// One lane's b = kp E + kd V over its last step.
template <int precision>
[[gnu::noinline]] void acceleration_of(const MeasuredLanes<precision>& lanes, int lane, LanePolynomial& out) {
  stroke_of(lanes, lane, out);
  const double kp = lanes.kp[lane], kd = lanes.kd[lane] * lanes.rate_start[lane];
  // In place: V[k] is (k + 1) times the coefficient after E's.
  for (int k = 0; k <= order; ++k) out.p[k] = std::fma(kp, out.p[k], kd * (k + 1) * out.p[k + 1]);
  out.p[order + 1] = kp * out.p[order + 1];
}

/// Raises a lane's peaks to the summits inside its last step that may be higher.
template <int precision>
[[gnu::noinline]] void reveal(MeasuredLanes<precision>& lanes, int lane, bool acceleration, bool force, bool stroke) {
  const double rate = lanes.rate_start[lane];
  const double x = lanes.done[lane] * rate;
  LanePolynomial f;
  const auto raise = [&](Row& peak, double unit) { peak[lane] = std::max(peak[lane], highest_summit(f, x) * unit); };
  if (acceleration) {
    acceleration_of(lanes, lane, f);
    raise(lanes.peak_acceleration, lanes.scale[lane]);
  }
  if (force) {
    force_of(lanes, lane, f);
    raise(lanes.peak_force, lanes.force_unit[lane] * (rate * rate));
  }
  if (stroke) {
    stroke_of(lanes, lane, f);
    raise(lanes.peak_stroke, lanes.scale[lane]);
  }
}

}  // namespace steerstat::STEERSTAT_ISA
