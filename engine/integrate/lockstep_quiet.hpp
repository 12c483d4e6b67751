// Proofs that no guard has fired in a step. Included once by a source compiled for an instruction set, after the lanes;
// see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

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

/// Where sums at a step's quarters leave off; of the terms from there on, 3/4 of a step has a tenth.
inline constexpr int last_quarter_term = 7;

/// Bounds on a step's motion.
struct Bend {
  Single velocity;  ///< how far it strays from a straight line: h^2 |second derivative| of the watched one, at most
  Single position;  ///< the same of its integral
  Single tail;      ///< what terms above last_quarter_term make of the velocity or the position, within 3/4 of the step
};

/// @param aligning  watch V there, w elsewhere
/// @param t         the step in the series' units, @param rate  those units a second
template <int precision>
Bend bound_bend(const Expansion<precision>& series, Mask aligning, Single t, Single rate) {
  const auto watched = [&](int k) { return abs(select(aligning, series.V_short[k], series.w_short[k])); };
  Single sum = watched(order) * Single(1.0 * order * (order - 1));
  Single high = sum;
  unroll<0, order - 2>([&]<int i>() __attribute__((always_inline)) {
    constexpr int k = order - 1 - i;
    sum = fma(sum, t, watched(k) * Single(1.0 * k * (k - 1)));
    if constexpr (k == last_quarter_term + 1) high = sum;
  });
  const Single square = t * t;
  sum = sum * square * Single(1.0 + 1e-5);  // with the roundings of this sum
  constexpr int k = last_quarter_term + 1;
  static_assert(k == 8, "t^k below");
  // The terms are `high` t^k over k (k - 1) at most; (3/4)^k < 0.1002. An integral has t / (k + 1) of it.
  const Single tail = high * (square * square) * (square * square) * Single(0.1002 / (k * (k - 1)));
  return {sum * rate, fma(watched(1), t, sum) * t, fma(t, Single(1.0 / (k + 1)), rate) * tail};
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
    V[i] = series.V_short[last_quarter_term];
    E[i] = V[i] * Single(1.0 / (last_quarter_term + 1));
    unroll<0, last_quarter_term>([&]<int j>() __attribute__((always_inline)) {
      constexpr int k = last_quarter_term - 1 - j;
      V[i] = fma(V[i], part, series.V_short[k]);
      E[i] = fma(E[i], part, series.V_short[k] * Single(1.0 / (k + 1)));
    });
    E[i] = fma(E[i], part, E0);
    V[i] = V[i] * rate;
  });
  const Single slack = (bend.velocity + bend.position) * Single(1.0 / 128) + bend.tail;
  const Single rounding =
      (abs(E0) + abs(V0) + abs(series.V_short[0] * t) + bend.velocity + bend.position) * Single(2e-6);
  const Single limit = radius + slack + rounding;
  return chord_avoids(E0, V0, E[0], V[0], limit) & chord_avoids(E[0], V[0], E[1], V[1], limit) &
         chord_avoids(E[1], V[1], E[2], V[2], limit) & chord_avoids(E[2], V[2], E1, V1, limit);
}

/// Whether no guard can have fired in the step that was just taken.
///
/// @param t  the step in the series' units, @param rate  those units a second
template <int precision>
Mask proves_quiet(const Lanes<precision>& lanes, Pack t, Pack rate, Bend bend) {
  const Pack radius = load(lanes.radius);
  const Mask far =
      (radius < Pack(0.0)) | stays_out(lanes.series, narrow(load(lanes.E_start)), narrow(lanes.series.V[0] * rate),
                                       narrow(load(lanes.E)), narrow(load(lanes.V)), narrow(radius), bend, narrow(t),
                                       narrow(rate));
  const Pack q20 = load(lanes.q2_start), q2 = load(lanes.q2);
  const Pack w0 = lanes.series.w[0] * rate, w = load(lanes.w);
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

}  // namespace steerstat::STEERSTAT_ISA
