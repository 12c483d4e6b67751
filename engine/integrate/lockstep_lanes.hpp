// One integration step of a pack of trials, each with its own plant, law, time and step size. Included once by a
// source compiled for an instruction set, after the series; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

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
struct LaneRows {
  Row E, q2, V, w;          ///< state at the step's start
  Row t, t_end;             ///< [s] since the phase's start; where the phase ends unless a guard fires
  Row unit, rate;           ///< the series' unit of time [s], a power of two, and its reciprocal
  LoopConstants<Row> loop;  ///< of the trial, per second
  Row scale;                ///< 1 / |K|, what a unit of E or V is in m or m/s
  Row kp, kd;               ///< of LawSeries, per second; zero unless aligning
  Row cycle[5];             ///< b = sum of cycle[i] t^(i + 1), t [s] since the phase's start; zero unless in a cycle
  Row radius;               ///< align: the guard's tolerance times |K|; negative: no such guard
  Row ceiling;              ///< align: the bound on |b|; infinite: no such guard
  Row q2_low, q2_high, direction, speed_floor;  ///< drift: the guards of Phase

  // Of the last step: where it began, its size, and how far its velocities strayed from straight lines.
  Row E_start, q2_start, t_start, rate_start;
  Row h;     ///< [s]
  Row bend;  ///< bound on h^2 |second derivative| of the watched velocity (V aligning, else w)
};

template <int precision>
struct Lanes : LaneRows {
  static constexpr bool measured = false;
  Expansion<precision> series;  ///< of the last step
};

/// Lanes whose exertion is measured; see lockstep_exertion.hpp.
template <int precision>
struct MeasuredLanes : Lanes<precision> {
  static constexpr bool measured = true;

  ForceSeries<precision> force;  ///< of the last step
  Row done;        ///< [s] how much of it was gone: less than h where a guard fired, 0 where it is retried
  Row force_unit;  ///< (m1 + m2) / |K|, what a unit of the force's series is in N where its unit of time is 1 s
  Row effort, peak_acceleration, peak_force, peak_stroke;  ///< of Exertion
};

/// What a step did, a bit a lane.
struct StepReport {
  std::uint32_t reached_end;  ///< came to t_end
  std::uint32_t watch;        ///< a guard may have fired: the search decides
  std::uint32_t unsound;      ///< the series is not finite
  std::uint32_t stalled;      ///< a step below 1e-12 s
};

/// The growth of the integral of a series over [0, t].
template <int precision>
Pack integral(const Pack (&x)[precision], const Single (&x_short)[order + 1], Pack t, Single t_short) {
  Pack sum(0.0);
  if constexpr (precision < full) {
    Single tail = x_short[order] * Single(1.0 / (order + 1));
    unroll<0, order - precision>([&]<int i>() __attribute__((always_inline)) {
      constexpr int k = order - 1 - i;
      tail = fma(tail, t_short, x_short[k] * Single(1.0 / (k + 1)));
    });
    sum = widen(tail);
  }
  unroll<0, precision>([&]<int i>() __attribute__((always_inline)) {
    constexpr int k = precision - 1 - i;
    sum = k == order ? x[k] * Pack(1.0 / (k + 1)) : fma(sum, t, x[k] * Pack(1.0 / (k + 1)));
  });
  return sum * t;
}

template <int precision>
Pack value(const Pack (&x)[precision], const Single (&x_short)[order + 1], Pack t, Single t_short) {
  Pack sum(0.0);
  if constexpr (precision < full) {
    Single tail = x_short[order];
    unroll<0, order - precision>([&]<int i>() __attribute__((always_inline)) {
      tail = fma(tail, t_short, x_short[order - 1 - i]);
    });
    sum = widen(tail);
  }
  unroll<0, precision>([&]<int i>() __attribute__((always_inline)) {
    constexpr int k = precision - 1 - i;
    sum = k == order ? x[k] : fma(sum, t, x[k]);
  });
  return sum;
}

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

/// Whether the chord from (E0, V0) to (E1, V1) stays further than `limit` from the origin (sufficient, nearly
/// necessary).
template <class Real>
auto chord_avoids(Real E0, Real V0, Real E1, Real V1, Real limit) {
  // Every point P + x (Q - P) has at least min((P + Q) P, (P + Q) Q) / |P + Q| along P + Q.
  const Real pp = fma(E0, E0, V0 * V0);
  const Real qq = fma(E1, E1, V1 * V1);
  const Real pq = fma(E0, E1, V0 * V1);
  const Real reach = min(pp, qq) + pq;
  const Real sum = fma(Real(2.0), pq, pp + qq);
  return (Real(0.0) < reach) & (limit * limit * sum < reach * reach);
}

/// Whether |b| = |kp E + kd V| stays below a ceiling over a step (sufficient).
///
/// @param position_bend, velocity_bend  bounds on h^2 |second derivative| of E and V
inline Mask stays_below(Pack kp, Pack kd, Pack E0, Pack V0, Pack E1, Pack V1, Pack position_bend, Pack velocity_bend,
                        Pack ceiling) {
  const Pack ends = max(abs(fma(kp, E0, kd * V0)), abs(fma(kp, E1, kd * V1)));
  const Pack strays = fma(abs(kp), position_bend, abs(kd) * velocity_bend);
  return fma(strays, Pack(1.0 / 8), ends) < ceiling;
}

/// Bounds on how far a step's motion strays from straight lines.
struct Bend {
  Single velocity;  ///< h^2 |second derivative| of the watched velocity, at most
  Single position;  ///< the same of its integral
};

/// @param aligning  watch V there, w elsewhere
/// @param t         the step in the series' units, @param rate  those units a second
template <int precision>
Bend bound_bend(const Expansion<precision>& series, Mask aligning, Single t, Single rate) {
  const auto watched = [&](int k) { return abs(select(aligning, series.V_short[k], series.w_short[k])); };
  Single sum = watched(order) * Single(1.0 * order * (order - 1));
  unroll<0, order - 2>([&]<int i>() __attribute__((always_inline)) {
    constexpr int k = order - 1 - i;
    sum = fma(sum, t, watched(k) * Single(1.0 * k * (k - 1)));
  });
  sum = sum * (t * t) * Single(1.0 + 1e-5);  // with the roundings of this sum
  return {sum * rate, fma(watched(1), t, sum) * t};
}

/// Whether align's guard cannot have fired in the step: a proof, not a sample, in single precision with its roundings
/// allowed for.
///
/// Over a time d a smooth x(t) stays within d^2 max|x''| / 8 of the chord between its ends; the step is cut into four.
///
/// @param E0, V0, E1, V1  at the step's ends
template <int precision>
Mask stays_out(const Expansion<precision>& series, Single E0, Single V0, Single E1, Single V1, Single radius, Bend bend,
               Single t, Single rate) {
  Single E[3], V[3];  // at the quarters between
  unroll<0, 3>([&]<int i>() __attribute__((always_inline)) {
    const Single part = t * Single(0.25 * (i + 1));
    V[i] = series.V_short[order];
    E[i] = V[i] * Single(1.0 / (order + 1));
    unroll<0, order>([&]<int j>() __attribute__((always_inline)) {
      constexpr int k = order - 1 - j;
      V[i] = fma(V[i], part, series.V_short[k]);
      E[i] = fma(E[i], part, series.V_short[k] * Single(1.0 / (k + 1)));
    });
    E[i] = fma(E[i], part, E0);
    V[i] = V[i] * rate;
  });
  const Single slack = (bend.velocity + bend.position) * Single(1.0 / 128);
  const Single rounding =
      (abs(E0) + abs(V0) + abs(series.V_short[0] * t) + bend.velocity + bend.position) * Single(2e-6);
  const Single limit = radius + slack + rounding;
  return chord_avoids(E0, V0, E[0], V[0], limit) & chord_avoids(E[0], V[0], E[1], V[1], limit) &
         chord_avoids(E[1], V[1], E[2], V[2], limit) & chord_avoids(E[2], V[2], E1, V1, limit);
}

/// Whether no guard can have fired in the step.
template <int precision>
Mask proves_quiet(const Lanes<precision>& lanes, Pack E, Pack q2, Pack V, Pack w, Pack t, Pack rate, Bend bend) {
  const Pack radius = load(lanes.radius);
  const Mask far =
      (radius < Pack(0.0)) | stays_out(lanes.series, narrow(load(lanes.E)), narrow(load(lanes.V)), narrow(E), narrow(V),
                                       narrow(radius), bend, narrow(t), narrow(rate));
  const Pack q20 = load(lanes.q2), w0 = load(lanes.w);
  const Pack direction = load(lanes.direction);
  const Pack position_slack = widen(bend.position) * Pack(1.0 / 8);
  const Mask inside =
      (load(lanes.q2_low) < min(q20, q2) - position_slack) & (max(q20, q2) + position_slack < load(lanes.q2_high));
  const Mask fast =
      load(lanes.speed_floor) < fnma(widen(bend.velocity), Pack(1.0 / 8), min(direction * w0, direction * w));
  return far & inside & fast;
}

/// Lanes whose |b| may have come to its ceiling in the step just advanced, a bit each. Apart from proves_quiet(), for
/// few trials have a ceiling.
template <int precision>
[[gnu::noinline]] std::uint32_t may_reach_ceiling(const Lanes<precision>& lanes) {
  const Pack rate = load(lanes.rate_start), h = load(lanes.h), bend = load(lanes.bend);
  const Pack slope = abs(lanes.series.V[1]) * (rate * rate);
  const Mask below = stays_below(load(lanes.kp), load(lanes.kd), load(lanes.E_start), lanes.series.V[0] * rate,
                                 load(lanes.E), load(lanes.V), fma(slope, h, bend) * h, bend, load(lanes.ceiling));
  return bits(!below);
}

/// Advances every lane by one step of its own size. The state, t and the results are written; lanes that `watch` names
/// hold the state at the step's end, and the search corrects it where a guard fired.
///
/// @tparam L  Lanes or MeasuredLanes
template <class L>
[[gnu::noinline, gnu::flatten]] StepReport advance(L& lanes, double log2_tolerance) {
  const Pack t = load(lanes.t), unit = load(lanes.unit), rate = load(lanes.rate);
  const Pack E0 = load(lanes.E), q20 = load(lanes.q2), V0 = load(lanes.V), w0 = load(lanes.w);
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
  if constexpr (L::measured) {
    expand(loop, law, E0, q20, V0 * unit, w0 * unit, lanes.series, lanes.force);
  } else {
    expand(loop, law, E0, q20, V0 * unit, w0 * unit, lanes.series);
  }
  const auto& [series_V, series_w, V_short, w_short] = lanes.series;

  // A step may grow eightfold, no more: single precision does not reach further.
  const Pack log2 = min(log2_step(lanes.series, load(lanes.scale), rate, Pack(log2_tolerance)), Pack(3.0));
  const Pack allowed = coarse_exp2(log2) * unit;
  const Pack t_end = load(lanes.t_end);
  const Pack remaining = t_end - t;
  const Mask ends = remaining <= allowed;
  const Pack h = min(remaining, allowed);

  const Pack x = h * rate;
  const Single x_short = narrow(x);
  const Pack E = E0 + integral(series_V, V_short, x, x_short);
  const Pack q2 = q20 + integral(series_w, w_short, x, x_short);
  const Pack V = value(series_V, V_short, x, x_short) * rate;
  const Pack w = value(series_w, w_short, x, x_short) * rate;

  const Bend bend = bound_bend(lanes.series, Pack(0.0) <= load(lanes.radius), x_short, narrow(rate));
  const Mask quiet = proves_quiet(lanes, E, q2, V, w, x, rate, bend);
  const Mask sound = (abs(V_short[order]) < Single(1e30)) & (abs(w_short[order]) < Single(1e30)) &
                     (abs(V_short[order - 1]) < Single(1e30)) & (abs(w_short[order - 1]) < Single(1e30));
  const Mask stalled = allowed < Pack(1e-12);

  store(lanes.E_start, E0);
  store(lanes.q2_start, q20);
  store(lanes.t_start, t);
  store(lanes.rate_start, rate);
  store(lanes.h, h);
  if constexpr (L::measured) store(lanes.done, h);
  store(lanes.bend, widen(bend.velocity));
  store(lanes.E, E);
  store(lanes.q2, q2);
  store(lanes.V, V);
  store(lanes.w, w);
  store(lanes.t, select(ends, t_end, t + h));
  const Pack change = round_even(max(log2, Pack(-10.0)));
  store(lanes.unit, unit * two_to(change));
  store(lanes.rate, rate * two_to(-change));
  return {bits(ends), bits(!quiet), bits(!sound), bits(stalled)};
}

}  // namespace steerstat::STEERSTAT_ISA
