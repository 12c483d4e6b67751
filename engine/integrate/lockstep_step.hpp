// One integration step of packs of trials. Included once by a source compiled for an instruction set, after the proofs;
// see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// What a step did, a bit a lane.
struct StepReport {
  std::uint32_t reached_end;  ///< came to t_end
  std::uint32_t watch;        ///< a guard may have fired: the search decides
  std::uint32_t unsound;      ///< the series is not finite
  std::uint32_t stalled;      ///< a step below 1e-12 s
};

/// The cycle's polynomial about time t of its phase: coefficients of (t + dt)^i collected in dt.
inline void shift_cycle(const LaneRows& lanes, Pack t, Pack (&out)[6]) {
  out[0] = Pack(0.0);
  unroll<0, 5>([&]<int i>() __attribute__((always_inline)) { out[i + 1] = load(lanes.cycle[i]); });
  unroll<0, 5>([&]<int i>() __attribute__((always_inline)) {  // Horner's scheme once a coefficient
    unroll<0, 5 - i>([&]<int j>() __attribute__((always_inline)) { out[4 - j] = fma(out[5 - j], t, out[4 - j]); });
  });
}

/// Log2 of the largest step, in the series' units, whose last terms stay within the tolerance, from the last two
/// coefficients of both velocities [Jorba & Zou 2005].
template <int precision>
Pack log2_step(const Expansion<precision>& series, Pack scale, Pack rate, Pack log2_tolerance) {
  const auto& [V, w, V_short, w_short] = series;
  const Pack least(1e-290);
  const auto allowance = [&](int k) {
    const Pack size = max(abs(widen(V_short[k])) * scale, abs(widen(w_short[k]))) * rate;
    return (log2_tolerance - coarse_log2(max(size, least))) * Pack(1.0 / k);
  };
  return min(allowance(order), allowance(order - 1));
}

/// Expands the closed loops of a pack about the lanes' states.
///
/// @tparam L  Lanes or MeasuredLanes
template <class L>
void begin_step(L& lanes) {
  const Pack t = load(lanes.t), unit = load(lanes.unit);
  LawSeries law;
  Pack power = unit * unit;
  law.kp = load(lanes.kp) * power;
  law.kd = load(lanes.kd) * unit;
  shift_cycle(lanes, t, law.cycle);
  unroll<0, 6>([&]<int k>() __attribute__((always_inline)) {
    law.cycle[k] = law.cycle[k] * power;
    power = power * unit;
  });
  const LoopConstants<Pack> loop{load(lanes.loop.slip) * unit,    load(lanes.loop.mismatch), load(lanes.loop.drive),
                                 load(lanes.loop.damping) * unit, load(lanes.loop.belief),   load(lanes.loop.ratio)};
  const Pack V = load(lanes.V) * unit, w = load(lanes.w) * unit;
  if constexpr (L::measured) {
    expand(loop, law, load(lanes.E), load(lanes.q2), V, w, lanes.series, lanes.force);
  } else {
    expand(loop, law, load(lanes.E), load(lanes.q2), V, w, lanes.series);
  }
}

/// Chooses the sizes of the steps that the series allow, and the units of the next ones.
template <class L>
[[gnu::noinline, gnu::flatten]] void choose_step(L& lanes, double log2_tolerance, StepReport& report) {
  const Pack t = load(lanes.t), unit = load(lanes.unit), rate = load(lanes.rate);
  const auto& [series_V, series_w, V_short, w_short] = lanes.series;
  // A step may grow eightfold, no more: single precision does not reach further.
  const Pack log2 = min(log2_step(lanes.series, load(lanes.scale), rate, Pack(log2_tolerance)), Pack(3.0));
  const Pack allowed = coarse_exp2(log2) * unit;
  const Pack t_end = load(lanes.t_end);
  const Pack remaining = t_end - t;
  const Mask ends = remaining <= allowed;
  const Pack h = min(remaining, allowed);
  const Mask sound = (abs(V_short[order]) < Single(1e30)) & (abs(w_short[order]) < Single(1e30)) &
                     (abs(V_short[order - 1]) < Single(1e30)) & (abs(w_short[order - 1]) < Single(1e30));
  const Mask stalled = allowed < Pack(1e-12);
  store(lanes.t_start, t);
  store(lanes.rate_start, rate);
  store(lanes.h, h);
  if constexpr (L::measured) store(lanes.done, h);
  store(lanes.t, select(ends, t_end, t + h));
  const Pack change = round_even(max(log2, Pack(-10.0)));
  store(lanes.unit, unit * two_to(change));
  store(lanes.rate, rate * two_to(-change));
  report.reached_end = bits(ends);
  report.unsound = bits(!sound);
  report.stalled = bits(stalled);
}

/// Moves the lanes to the ends of their steps.
template <int precision>
[[gnu::noinline, gnu::flatten]] void move(Lanes<precision>& lanes) {
  const auto& [series_V, series_w, V_short, w_short] = lanes.series;
  const Pack rate = load(lanes.rate_start);
  const Pack x = load(lanes.h) * rate;
  const Single x_short = narrow(x);
  const Pack E0 = load(lanes.E), q20 = load(lanes.q2);
  store(lanes.E_start, E0);
  store(lanes.q2_start, q20);
  store(lanes.E, E0 + integral(series_V, V_short, x, x_short));
  store(lanes.q2, q20 + integral(series_w, w_short, x, x_short));
  store(lanes.V, value(series_V, V_short, x, x_short) * rate);
  store(lanes.w, value(series_w, w_short, x, x_short) * rate);
}

/// Finds the lanes whose guards the search has to look at.
template <int precision>
[[gnu::noinline, gnu::flatten]] void watch(Lanes<precision>& lanes, StepReport& report) {
  const Pack rate = load(lanes.rate_start);
  const Pack x = load(lanes.h) * rate;
  const Bend bend = bound_bend(lanes.series, Pack(0.0) <= load(lanes.radius), narrow(x), narrow(rate));
  store(lanes.bend, widen(bend.velocity));
  report.watch = bits(!proves_quiet(lanes, x, rate, bend));
}

/// Advances every lane by one step of its own size. The state, t and the results are written; lanes that `watch` names
/// hold the state at the step's end, and the search corrects it where a guard fired.
///
/// Each stage goes through all packs: what one waits for is the length of a step's sums, and the processor does the
/// next pack's meanwhile.
///
/// @tparam L  Lanes or MeasuredLanes
template <class L, int count>
void advance(L (&packs)[count], double log2_tolerance, StepReport (&reports)[count]) {
  for (L& lanes : packs) begin_step(lanes);
  for (int i = 0; i < count; ++i) choose_step(packs[i], log2_tolerance, reports[i]);
  for (L& lanes : packs) move(lanes);
  for (int i = 0; i < count; ++i) watch(packs[i], reports[i]);
}

}  // namespace steerstat::STEERSTAT_ISA
