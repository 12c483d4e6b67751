// One integration step of a pack of trials, each with its own plant, law, time and step size. Included once by a source
// compiled for an instruction set, after the series; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// Order of the Taylor series of the velocities.
inline constexpr int order = 12;

/// One double a lane.
struct alignas(64) Row {
  double lane[Pack::lanes];
  double& operator[](int i) { return lane[i]; }
  double operator[](int i) const { return lane[i]; }
};
inline Pack load(const Row& row) {
  return load(row.lane);
}
inline void store(Row& row, Pack x) {
  store(row.lane, x);
}

/// The trials under way, a column a lane: state, phase and constants, in the scaled coordinates of LoopConstants.
struct Lanes {
  Row E, q2, V, w;          ///< state at the step's start
  Row t, t_end;             ///< [s] since the phase's start; where the phase ends unless a guard fires
  LoopConstants<Row> loop;  ///< of the trial
  Row scale;                ///< 1 / |K|, what a unit of E or V is in m or m/s
  Row kp, kd;               ///< of LawSeries, zero unless aligning
  Row cycle[5];             ///< b = sum of cycle[i] t^(i + 1), t since the phase's start; zero unless in a cycle
  Row radius;               ///< align: the guard's tolerance times |K|; negative: no such guard
  Row q2_low, q2_high, direction, speed_floor;  ///< drift: the guards of Phase

  // Results of the step: where it began, the series, the step sizes and the bound for the guards.
  Row E_start, q2_start, t_start;
  Expansion<order> series;
  Row h;     ///< [s]
  Row bend;  ///< bound on h^2 |second derivative| of the watched velocity (V aligning, else w) over the step
};

/// What a step did, a bit a lane.
struct StepReport {
  std::uint32_t reached_end;  ///< came to t_end
  std::uint32_t watch;        ///< a guard may have fired: the search decides
  std::uint32_t failed;       ///< non-finite, or a step below 1e-12 s
};

/// The positions' growth over [0, t]: the integral of sum x[k] t^k.
inline Pack integral(const Pack (&x)[order + 1], Pack t) {
  Pack sum = x[order] * Pack(1.0 / (order + 1));
  unroll<0, order>([&]<int i>() {
    constexpr int k = order - 1 - i;
    sum = fma(sum, t, x[k] * Pack(1.0 / (k + 1)));
  });
  return sum * t;
}

inline Pack value(const Pack (&x)[order + 1], Pack t) {
  Pack sum = x[order];
  unroll<0, order>([&]<int i>() { sum = fma(sum, t, x[order - 1 - i]); });
  return sum;
}

/// The cycle's polynomial about time t of its phase: coefficients of (t + dt)^i collected in dt.
inline void shift_cycle(const Lanes& lanes, Pack t, Pack (&out)[6]) {
  Pack p[6] = {
      Pack(0.0),           load(lanes.cycle[0]), load(lanes.cycle[1]), load(lanes.cycle[2]), load(lanes.cycle[3]),
      load(lanes.cycle[4])};
  unroll<0, 5>([&]<int i>() {  // Horner's scheme once a coefficient
    unroll<0, 5 - i>([&]<int j>() { p[4 - j] = fma(p[5 - j], t, p[4 - j]); });
  });
  unroll<0, 6>([&]<int i>() { out[i] = p[i]; });
}

/// The largest step [s] whose first omitted terms stay within the tolerance, from the last two coefficients of both
/// velocities [Jorba & Zou 2005].
inline Pack step_size(const Lanes& lanes, Pack log2_tolerance) {
  const Pack scale = load(lanes.scale);
  const Pack least(1e-290);
  const auto& [V, w] = lanes.series;
  const Pack last = max(max(abs(V[order]) * scale, abs(w[order])), least);
  const Pack before = max(max(abs(V[order - 1]) * scale, abs(w[order - 1])), least);
  return coarse_exp2(min((log2_tolerance - coarse_log2(last)) * Pack(1.0 / order),
                         (log2_tolerance - coarse_log2(before)) * Pack(1.0 / (order - 1))));
}

/// Whether the chord from (E0, V0) to (E1, V1) stays further than `limit` from the origin (sufficient, nearly
/// necessary).
inline Mask chord_avoids(Pack E0, Pack V0, Pack E1, Pack V1, Pack limit) {
  // Every point P + x (Q - P) has at least min((P + Q) P, (P + Q) Q) / |P + Q| along P + Q.
  const Pack pp = fma(E0, E0, V0 * V0);
  const Pack qq = fma(E1, E1, V1 * V1);
  const Pack pq = fma(E0, E1, V0 * V1);
  const Pack reach = min(pp, qq) + pq;
  const Pack sum = fma(Pack(2.0), pq, pp + qq);
  return (Pack(0.0) < reach) & (limit * limit * sum < reach * reach);
}

/// Whether no guard can have fired in the step: a proof, not a sample.
///
/// Over a time d a smooth x(t) stays within d^2 max|x''| / 8 of the chord between its ends.
///
/// @param middle  E and V half-way through the step
inline Mask proves_quiet(const Lanes& lanes, Pack E, Pack q2, Pack V, Pack w, Pack middle_E, Pack middle_V,
                         Pack velocity_bend, Pack position_bend) {
  const Pack radius = load(lanes.radius);
  const Pack limit = fma(velocity_bend + position_bend, Pack(1.0 / 32), radius);
  const Mask far = (radius < Pack(0.0)) | (chord_avoids(load(lanes.E), load(lanes.V), middle_E, middle_V, limit) &
                                           chord_avoids(middle_E, middle_V, E, V, limit));
  const Pack q20 = load(lanes.q2), w0 = load(lanes.w);
  const Pack direction = load(lanes.direction);
  const Pack position_slack = position_bend * Pack(1.0 / 8);
  const Mask inside =
      (load(lanes.q2_low) < min(q20, q2) - position_slack) & (max(q20, q2) + position_slack < load(lanes.q2_high));
  const Mask fast = load(lanes.speed_floor) < fnma(velocity_bend, Pack(1.0 / 8), min(direction * w0, direction * w));
  return far & inside & fast;
}

/// Advances every lane by one step of its own size. The state, t and the results are written; lanes that `watch` names
/// hold the state at the step's end, and the search corrects it where a guard fired.
[[gnu::noinline, gnu::flatten]] inline StepReport advance(Lanes& lanes, double log2_tolerance) {
  const Pack t = load(lanes.t);
  const Pack E0 = load(lanes.E), q20 = load(lanes.q2), V0 = load(lanes.V), w0 = load(lanes.w);
  LawSeries law;
  law.kp = load(lanes.kp);
  law.kd = load(lanes.kd);
  shift_cycle(lanes, t, law.cycle);
  const LoopConstants<Pack> loop{load(lanes.loop.slip),    load(lanes.loop.mismatch), load(lanes.loop.drive),
                                 load(lanes.loop.damping), load(lanes.loop.belief),   load(lanes.loop.ratio)};
  expand<order>(loop, law, E0, q20, V0, w0, lanes.series);
  const auto& [series_V, series_w] = lanes.series;

  const Pack allowed = step_size(lanes, Pack(log2_tolerance));
  const Pack t_end = load(lanes.t_end);
  const Pack remaining = t_end - t;
  const Mask ends = remaining <= allowed;
  const Pack h = min(remaining, allowed);

  const Pack E = E0 + integral(series_V, h);
  const Pack q2 = q20 + integral(series_w, h);
  const Pack V = value(series_V, h);
  const Pack w = value(series_w, h);

  // h^2 |x''| of the watched velocity and of its integral, at most.
  const Mask aligning = Pack(0.0) <= load(lanes.radius);
  Pack velocity_bend(0.0);
  unroll<0, order - 1>([&]<int i>() {
    constexpr int k = order - i;
    velocity_bend = fma(velocity_bend, h, abs(select(aligning, series_V[k], series_w[k])) * Pack(1.0 * k * (k - 1)));
  });
  velocity_bend = velocity_bend * h;
  const Pack position_bend = (velocity_bend + abs(select(aligning, series_V[1], series_w[1]))) * (h * h);
  velocity_bend = velocity_bend * h;

  const Pack half = h * Pack(0.5);
  const Mask quiet = proves_quiet(lanes, E, q2, V, w, E0 + integral(series_V, half), value(series_V, half),
                                  velocity_bend, position_bend);
  const Mask sound =
      (abs(series_V[order]) < Pack(1e290)) & (abs(series_w[order]) < Pack(1e290)) & (Pack(1e-12) <= allowed);
  store(lanes.E_start, E0);
  store(lanes.q2_start, q20);
  store(lanes.t_start, t);
  store(lanes.h, h);
  store(lanes.bend, velocity_bend);
  store(lanes.E, E);
  store(lanes.q2, q2);
  store(lanes.V, V);
  store(lanes.w, w);
  store(lanes.t, select(ends, t_end, t + h));
  return {bits(ends), bits(!quiet), bits(!sound)};
}

}  // namespace steerstat::STEERSTAT_ISA
