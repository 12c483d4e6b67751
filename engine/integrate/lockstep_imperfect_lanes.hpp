// One integration step of a pack of trials with imperfections. Included once by a source compiled for an instruction
// set, after the series and the guards; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// The trials under way; E is about where align sees the goal.
struct ImperfectLanes : LaneRows {
  ImperfectConstants<Row> loop;  ///< of the trial, per second
  Row read_V;                    ///< align: what is read of V, less V, per second
  Row mode;                      ///< where the force stands, such as within_limits
  Row force_bend;                ///< of the last step: bound on h^2 |second derivative| of the force asked for
  ImperfectExpansion series;     ///< of the last step
};

/// What a step did, a bit a lane.
struct ImperfectReport {
  StepReport step;
  std::uint32_t force;  ///< the force asked for may have crossed the limit
};

/// Sum of |x[k]| t^k for k = 1 ... n: how far a series may stray from its value at 0.
inline Pack reach(const Pack* x, int n, Pack t) {
  Pack sum = abs(x[n]);
  for (int k = n - 1; k >= 1; --k) sum = fma(sum, t, abs(x[k]));
  return sum * t;
}

/// Bound on t^2 |second derivative|, over [0, t].
inline Pack second_difference(const Pack* x, int n, Pack t) {
  Pack sum = abs(x[n]) * Pack(1.0 * n * (n - 1));
  for (int k = n - 1; k >= 2; --k) sum = fma(sum, t, abs(x[k]) * Pack(1.0 * k * (k - 1)));
  return sum * (t * t) * Pack(1.0 + 1e-10);  // with the roundings of this sum
}

struct PackMotion {
  Pack growth;    ///< of the position
  Pack velocity;  ///< at the end
};
inline PackMotion motion(const Pack* x, Pack t) {
  Pack velocity = x[order];
  Pack position = velocity * Pack(1.0 / (order + 1));
  for (int k = order - 1; k >= 0; --k) {
    velocity = fma(velocity, t, x[k]);
    position = fma(position, t, x[k] * Pack(1.0 / (k + 1)));
  }
  return {position * t, velocity};
}

/// The step, in the series' units, within which |velocity - x[0]| stays below three quarters of its distance to the
/// singularities +-i smoothing of share(), so that the share's series converges.
///
/// The last coefficients alone would not tell: far from a standstill the singularities are weak, and a step might
/// cross them before they show.
inline Pack within_convergence(const Pack* x, Pack sharpness, Pack t) {
  const Pack smoothing = Pack(1.0) / sharpness;
  const Pack distance = Pack(0.75) * sqrt(fma(x[0], x[0], smoothing * smoothing));
  for (int i = 0; i < 3; ++i) {  // the sum is convex and 0 at 0: this never overshoots, and comes close
    const Pack strays = reach(x, order, t);
    t = select(distance < strays, t * (distance / strays), t);
  }
  return t;
}

/// Largest step, in the series' units, whose last terms stay within the tolerance [Jorba & Zou 2005], and that a
/// lane's friction allows.
template <bool rubs>
Pack allowed_step(const ImperfectExpansion& series, const ImperfectConstants<Pack>& loop, Pack scale, Pack rate,
                  Pack log2_tolerance) {
  const auto allowance = [&](int k) {
    const Pack size = max(abs(series.V[k]) * scale, abs(series.w[k])) * rate;
    return (log2_tolerance - coarse_log2(max(size, Pack(1e-290)))) * Pack(1.0 / k);
  };
  // A step may grow eightfold, no more: the coefficients' units are near the step before.
  const Pack log2 = min(min(allowance(order), allowance(order - 1)), Pack(3.0));
  Pack t = coarse_exp2(max(log2, Pack(-60.0)));
  if constexpr (rubs) {
    t = select(Pack(0.0) < loop.rub1, within_convergence(series.V, loop.sharp1, t), t);
    t = select(Pack(0.0) < loop.rub2, within_convergence(series.w, loop.sharp2, t), t);
  }
  return t;
}

/// Whether no guard can have fired in the step, of velocity bends per second.
inline Mask proves_quiet(const ImperfectLanes& lanes, Pack E, Pack q2, Pack V, Pack w, Pack velocity_bend,
                         Pack position_bend) {
  const Pack radius = load(lanes.radius);
  const Pack read_V0 = load(lanes.V) + load(lanes.read_V), read_V = V + load(lanes.read_V);
  const Pack eighth(1.0 / 8);
  const Mask far = (radius < Pack(0.0)) |
                   chord_avoids(load(lanes.E), read_V0, E, read_V, radius + (velocity_bend + position_bend) * eighth);
  const Mask below = stays_below(load(lanes.kp), load(lanes.kd), load(lanes.E), read_V0, E, read_V, position_bend,
                                 velocity_bend, load(lanes.ceiling));
  const Pack q20 = load(lanes.q2), w0 = load(lanes.w), direction = load(lanes.direction);
  const Pack slack = position_bend * eighth;
  const Mask inside = (load(lanes.q2_low) < min(q20, q2) - slack) & (max(q20, q2) + slack < load(lanes.q2_high));
  const Mask fast = load(lanes.speed_floor) < fnma(velocity_bend, eighth, min(direction * w0, direction * w));
  return far & below & inside & fast;
}

/// Advances every lane by one step of its own size, as the advance() without imperfections does.
template <bool rubs>
[[gnu::noinline]] ImperfectReport advance(ImperfectLanes& lanes, double log2_tolerance) {
  const Pack t = load(lanes.t), unit = load(lanes.unit), rate = load(lanes.rate);
  const Pack E0 = load(lanes.E), q20 = load(lanes.q2), V0 = load(lanes.V), w0 = load(lanes.w);
  LawSeries law;
  Pack power = unit * unit;
  const auto in_units = [&](const Row& acceleration) { return load(acceleration) * (unit * unit); };
  law.kp = in_units(lanes.kp);
  law.kd = load(lanes.kd) * unit;
  shift_cycle(lanes, t, law.cycle);
  for (int k = 0; k < 6; ++k) {
    law.cycle[k] = law.cycle[k] * power;
    power = power * unit;
  }
  const ImperfectConstants<Row>& rows = lanes.loop;
  const ImperfectConstants<Pack> loop{load(rows.slip) * unit,  load(rows.damping) * unit, load(rows.pull),
                                      load(rows.drive),        load(rows.belief),         load(rows.belief_b),
                                      in_units(rows.limit),    in_units(rows.fall),       in_units(rows.tilt),
                                      in_units(rows.rub1),     in_units(rows.rub2),       load(rows.sharp1) * rate,
                                      load(rows.sharp2) * rate};
  const auto& [V_series, w_series, D, mode] = lanes.series;
  expand<rubs>(loop, law, load(lanes.read_V) * unit, E0, q20, V0 * unit, w0 * unit, load(lanes.mode), lanes.series);

  const Pack longest = allowed_step<rubs>(lanes.series, loop, load(lanes.scale), rate, Pack(log2_tolerance));
  const Pack allowed = longest * unit;
  const Pack t_end = load(lanes.t_end);
  const Pack remaining = t_end - t;
  const Mask ends = remaining <= allowed;
  const Pack h = min(remaining, allowed);
  const Pack x = h * rate;
  const PackMotion first = motion(V_series, x);
  const PackMotion second = motion(w_series, x);
  const Pack E = E0 + first.growth, V = first.velocity * rate;
  const Pack q2 = q20 + second.growth, w = second.velocity * rate;

  const Mask aligning = Pack(0.0) <= load(lanes.radius);
  const Pack bend = select(aligning, second_difference(V_series, order, x), second_difference(w_series, order, x));
  const Pack slope = select(aligning, abs(V_series[1]), abs(w_series[1]));
  const Mask quiet = proves_quiet(lanes, E, q2, V, w, bend * rate, fma(slope, x, bend) * x);
  // Within the limits |D| stays below it; at one, D with its sign stays above.
  const Pack strays = reach(D, order - 1, x);
  const Mask within = abs(mode) <= Pack(0.0);
  const Mask settled =
      select(within, abs(D[0]) + strays, loop.limit) < select(within, loop.limit, mode * D[0] - strays);
  const Pack huge(1e280);
  const Mask sound = (abs(V_series[order]) < huge) & (abs(w_series[order]) < huge) & (abs(V_series[order - 1]) < huge) &
                     (abs(w_series[order - 1]) < huge);

  store(lanes.E_start, E0);
  store(lanes.q2_start, q20);
  store(lanes.t_start, t);
  store(lanes.rate_start, rate);
  store(lanes.h, h);
  store(lanes.bend, bend * rate);
  store(lanes.force_bend, second_difference(D, order - 1, x) * (rate * rate));
  store(lanes.mode, mode);
  store(lanes.E, E);
  store(lanes.q2, q2);
  store(lanes.V, V);
  store(lanes.w, w);
  store(lanes.t, select(ends, t_end, t + h));
  const Pack change = round_even(max(coarse_log2(max(longest, Pack(1e-290))), Pack(-10.0)));
  store(lanes.unit, unit * two_to(change));
  store(lanes.rate, rate * two_to(-change));
  return {{bits(ends), bits(!quiet), bits(!sound), bits(allowed < Pack(least_step))}, bits(!settled)};
}

}  // namespace steerstat::STEERSTAT_ISA
