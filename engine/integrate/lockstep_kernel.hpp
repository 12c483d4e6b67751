// The lockstep engine on one instruction set. Included once by a source compiled for it, after the guards; see
// core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// Packs advanced one after another before anyone looks at what has ended, so that code and branch history stay warm.
inline constexpr int pack_count = 4;

///
/// @tparam measured  whether trials' exertion is measured
template <int precision, bool measured>
class Kernel final : public LockstepEngine {
 public:
  explicit Kernel(double tolerance) : log2_tolerance_(natural_log(margin * tolerance) * elementary::log2_e) {
    for (int lane = 0; lane < lanes(); ++lane) vacate(lane);
  }

  [[nodiscard]] InstructionSet instruction_set() const override { return InstructionSet::STEERSTAT_ISA; }
  [[nodiscard]] int lanes() const override { return pack_count * Pack::lanes; }

  void seat(int lane, const ClosedLoop<double>& loop) override {
    const PlantConstants<double>& plant = loop.plant;
    const PlantConstants<double>& nominal = loop.nominal;
    const double K = plant.moment / plant.inertia;
    Trial& trial = trials_[lane];
    trial.K = K;
    trial.loop = loop;
    const auto [lanes, i] = place(lane);
    lanes.loop.slip[i] = plant.f2 / plant.inertia;
    lanes.loop.mismatch[i] = K * (plant.moment - nominal.moment) / plant.mass;
    lanes.loop.drive[i] = nominal.mass / plant.mass;
    lanes.loop.damping[i] = plant.f1 / plant.mass;
    lanes.loop.belief[i] = K * nominal.moment / plant.mass;
    lanes.loop.ratio[i] = nominal.moment / nominal.inertia / K;
    lanes.scale[i] = 1.0 / std::abs(K);
    if constexpr (measured) lanes.force_unit[i] = plant.mass / std::abs(K);
    set_exertion(lane, Exertion{});
    seated_ |= bit(lane);
  }

  void set_exertion(int lane, const Exertion& exertion) override {
    if constexpr (measured) {
      const auto [lanes, i] = place(lane);
      lanes.effort[i] = exertion.effort;
      lanes.peak_acceleration[i] = exertion.peak_acceleration;
      lanes.peak_force[i] = exertion.peak_force;
      lanes.peak_stroke[i] = exertion.peak_stroke;
    }
  }

  [[nodiscard]] Exertion exertion(int lane) const override {
    if constexpr (measured) {
      const auto [lanes, i] = place(lane);
      return {lanes.effort[i], lanes.peak_acceleration[i], lanes.peak_force[i], lanes.peak_stroke[i]};
    }
    return {};
  }

  void start(int lane, const Phase& phase, double t, const State<double>& x, double t_end) override {
    Trial& trial = trials_[lane];
    trial.t_start = t;
    trial.t_end = t_end;
    trial.cause = Cause::time;
    const double K = trial.K;
    const double E = K * (x.q1 - trial.loop.q1_goal);
    const double V = K * x.q1_dot;
    const auto [lanes, i] = place(lane);
    lanes.E[i] = E;
    lanes.V[i] = V;
    lanes.q2[i] = x.q2;
    lanes.w[i] = x.q2_dot;
    lanes.t[i] = 0.0;
    lanes.t_end[i] = t_end - t;
    set_unit(lane, phase.kind == PhaseKind::drift ? 2.0 : 0.25);  // soon corrected by the steps themselves

    const bool aligning = phase.kind == PhaseKind::align;
    const auto [kp, kd] = align_gains(trial.loop, phase);
    lanes.kp[i] = aligning ? -kp : 0.0;
    lanes.kd[i] = aligning ? -kd : 0.0;
    const bool cycling = phase.kind == PhaseKind::contraction || phase.kind == PhaseKind::swing;
    const double rate = cycling ? 1.0 / phase.duration : 0.0;
    double factor = cycling ? K * phase.amplitude * rate * rate : 0.0;  // (11)
    if constexpr (measured) {
      trial.phase = phase;
      trial.cycle_bound = std::abs(factor) * lanes.scale[i] * (cycle_peak * (1.0 + 1e-12));
    }
    for (std::size_t k = 0; k < 5; ++k) {
      factor *= rate;
      lanes.cycle[k][i] = cycle_coefficients[k] * factor;
    }
    const double radius = phase.active_tolerance < 0.0 ? -1.0 : std::abs(K) * phase.active_tolerance;
    lanes.radius[i] = radius;
    const double ceiling = std::abs(K) * phase.ceiling;
    lanes.ceiling[i] = ceiling;
    lanes.q2_low[i] = phase.q2_low;
    lanes.q2_high[i] = phase.q2_high;
    lanes.direction[i] = phase.direction;
    lanes.speed_floor[i] = phase.speed_floor;
    const bool armed = (radius < 0.0 || E * E + V * V > radius * radius) &&
                       std::abs(lanes.kp[i] * E + lanes.kd[i] * V) < ceiling && x.q2 > phase.q2_low &&
                       x.q2 < phase.q2_high && phase.direction * x.q2_dot > phase.speed_floor;
    armed_ = (armed_ & ~bit(lane)) | (armed ? bit(lane) : 0);
    capped_ = (capped_ & ~bit(lane)) | (ceiling < Phase::unbounded ? bit(lane) : 0);
  }

  void vacate(int lane) override {
    const PlantParameters<double> any;
    seat(lane, {constants_of(any), constants_of(any), 0.0, 0.0, 0.0});
    start(lane, Phase{PhaseKind::drift}, 0.0, State<double>{}, 1.0);
    seated_ &= ~bit(lane);
  }

  std::uint64_t step() override {
    StepReport reports[pack_count];
    advance(packs_, log2_tolerance_, reports);
    std::uint64_t ended = 0, watch = 0, unsound = 0, stalled = 0;
    for (int pack = 0; pack < pack_count; ++pack) {
      const StepReport& report = reports[pack];
      const auto at_its_place = [&](std::uint32_t bits) { return std::uint64_t{bits} << (pack * Pack::lanes); };
      ended |= at_its_place(report.reached_end);
      watch |= at_its_place(report.watch);
      unsound |= at_its_place(report.unsound);
      stalled |= at_its_place(report.stalled);
      if ((capped_ & at_its_place(all_lanes)) != 0) watch |= at_its_place(may_reach_ceiling(packs_[pack]));
    }
    counters_.steps += pack_count;
    counters_.lane_slots += static_cast<std::uint64_t>(lanes());
    counters_.lane_steps += static_cast<std::uint64_t>(std::popcount(seated_));
    for_each_lane(ended & ~seated_, [&](int lane) { set_time(lane, 0.0); });

    ended &= seated_ & ~unsound;
    ended |= search(watch & seated_ & ~unsound);
    armed_ |= ~watch;  // every guard of these was positive throughout
    for_each_lane(stalled & seated_ & ~unsound, [&](int lane) {
      trials_[lane].cause = Cause::failure;
      ended |= bit(lane);
    });
    for_each_lane(unsound & seated_, [&](int lane) {
      if (!retry(lane)) ended |= bit(lane);
    });
    if constexpr (measured) measure_step(ended);
    counters_.arrivals += static_cast<std::uint64_t>(std::popcount(ended));
    return ended;
  }

  [[nodiscard]] Arrival arrival(int lane) const override {
    const Trial& trial = trials_[lane];
    const auto [lanes, i] = place(lane);
    const double t = lanes.t[i];
    return {t == lanes.t_end[i] ? trial.t_end : trial.t_start + t,
            {trial.loop.q1_goal + lanes.E[i] / trial.K, lanes.q2[i], lanes.V[i] / trial.K, lanes.w[i]},
            trial.cause};
  }

  [[nodiscard]] State<double> dense_output(int lane, double t) const override {
    const Trial& trial = trials_[lane];
    const auto [lanes, i] = place(lane);
    const double dt = t - (trial.t_start + lanes.t_start[i]);
    StepMotion<double> motion;
    take_lane(lanes, i, motion);
    Moment<double> moment;
    motion.at(dt, moment);
    const auto& [first, second] = moment.joint;
    return {trial.loop.q1_goal + first.position / trial.K, second.position, first.velocity / trial.K, second.velocity};
  }

 private:
  /// Long trials amplify what a step gets wrong. With this share of the tolerance for a step's last terms, settling
  /// times of the combined study come out right to a hundred tolerances in the median.
  static constexpr double margin = 0.125;
  static constexpr std::uint32_t all_lanes = ~std::uint32_t{0} >> (32 - Pack::lanes);  // of a pack

  struct Trial {
    ClosedLoop<double> loop;
    double K;
    double t_start, t_end;
    Phase phase;         // where it is measured
    double cycle_bound;  // of a cycle's |a|; 0 in another phase
    Cause cause;
  };

  using LanesType = std::conditional_t<measured, MeasuredLanes<precision>, Lanes<precision>>;

  /// Where a lane's columns are.
  template <class L>
  struct Place {
    L& lanes;
    int column;
  };
  Place<LanesType> place(int lane) { return {packs_[lane / Pack::lanes], lane % Pack::lanes}; }
  [[nodiscard]] Place<const LanesType> place(int lane) const {
    return {packs_[lane / Pack::lanes], lane % Pack::lanes};
  }

  static std::uint64_t bit(int lane) { return std::uint64_t{1} << lane; }

  template <class Body>
  static void for_each_lane(std::uint64_t lanes, Body&& body) {
    for (; lanes != 0; lanes &= lanes - 1) body(std::countr_zero(lanes));
  }

  void set_time(int lane, double t) {
    const auto [lanes, i] = place(lane);
    lanes.t[i] = t;
  }

  void set_unit(int lane, double unit) {
    const auto [lanes, i] = place(lane);
    lanes.unit[i] = unit;
    lanes.rate[i] = 1.0 / unit;
  }

  /// Puts lanes to where a guard fired within their last step. @return those where one did
  std::uint64_t search(std::uint64_t suspects) {
    std::uint64_t fired = 0;
    for_each_lane(suspects, [&](int lane) {
      ++counters_.searches;
      if (firings_.count + most_guards > slots) fired |= fire();
      note_firings(lane);
    });
    return fired | fire();
  }

  /// Adds the guards of a lane's phase that fire within its last step.
  void note_firings(int lane) {
    const auto [lanes, i] = place(lane);
    const bool aligning = lanes.radius[i] >= 0.0;
    int slot = firings_.count;
    take_lane(lanes, i, firings_.motion, slot);
    const SeriesView joint = view(firings_.motion.joint[aligning ? 0 : 1], slot);
    const double h = lanes.h[i], bend = lanes.bend[i] / (h * h);
    const bool armed = (armed_ & bit(lane)) != 0;
    Samples samples;
    sample(joint, 0.0, h, joint.start, joint.x[0] * joint.rate, samples);
    const auto consider = [&](const auto& guard, double bound) {
      Bracket<double> bracket;
      if (!(std::abs(bound) < Phase::unbounded)) return;
      if (!bracket_crossing(guard, joint, samples, bend, armed, 0, bracket)) return;
      if (firings_.count > slot) take_lane(lanes, i, firings_.motion, firings_.count);
      firings_.add(lane, guard.terms(), bracket);
    };
    if (aligning) {
      consider(AlignGuard{lanes.radius[i]}, lanes.radius[i]);
      const double kp = lanes.kp[i], kd = lanes.kd[i], ceiling = lanes.ceiling[i];
      consider(CeilingGuard{kp, kd, 1.0, ceiling}, ceiling);
      consider(CeilingGuard{kp, kd, -1.0, ceiling}, ceiling);
    } else {
      const auto consider_drift = [&](const DriftGuard& guard) { consider(guard, guard.bound); };
      consider_drift({false, 1.0, lanes.q2_low[i]});
      consider_drift({false, -1.0, -lanes.q2_high[i]});
      consider_drift({true, lanes.direction[i], lanes.speed_floor[i]});
    }
  }

  /// Puts the lanes of the firings noted to the first of theirs.
  std::uint64_t fire() {
    std::uint64_t fired = 0;
    firings_.locate();
    for (int slot = 0; slot < firings_.count; ++slot) {
      const int lane = firings_.lane[slot];
      const auto [lanes, i] = place(lane);
      const double t = lanes.t_start[i] + firings_.t[slot];
      if ((fired & bit(lane)) != 0 && lanes.t[i] <= t) continue;
      fired |= bit(lane);
      lanes.E[i] = firings_.E[slot];
      lanes.V[i] = firings_.V[slot];
      lanes.q2[i] = firings_.q2[slot];
      lanes.w[i] = firings_.w[slot];
      lanes.t[i] = t;
      if constexpr (measured) lanes.done[i] = firings_.t[slot];
      trials_[lane].cause = Cause::guard;
    }
    firings_.count = 0;
    return fired;
  }

  /// Measures every lane's last step. @param ended  lanes whose phase has ended
  void measure_step(std::uint64_t ended) {
    for (int pack = 0; pack < pack_count; ++pack) {
      const Open open = measure(packs_[pack]);
      const auto seated = static_cast<std::uint32_t>(seated_ >> (pack * Pack::lanes));
      for_each_lane((open.acceleration | open.force | open.stroke) & seated & ~open.unresolved, [&](int i) {
        const auto in = [&](std::uint32_t bits) { return (bits >> i & 1) != 0; };
        reveal(packs_[pack], i, in(open.acceleration), in(open.force), in(open.stroke));
      });
      for_each_lane(open.unresolved & seated, [&](int i) { measure_in_parts(pack * Pack::lanes + i); });
    }
    for_each_lane(ended, [&](int lane) {
      const Trial& trial = trials_[lane];
      const auto [lanes, i] = place(lane);
      if (trial.cycle_bound <= lanes.peak_acceleration[i]) return;
      const double peak = peak_of_cycle(trial.phase, lanes.t[i]);
      lanes.peak_acceleration[i] = std::max(lanes.peak_acceleration[i], peak);
    });
  }

  /// Measures a lane's last step where packs cannot.
  void measure_in_parts(int lane) {
    const Trial& trial = trials_[lane];
    const auto [lanes, i] = place(lane);
    const double from = trial.t_start + lanes.t_start[i];
    Exertion so_far = exertion(lane);
    meter(trial.loop, trial.phase, trial.t_start, from, from + lanes.done[i], lane, so_far);
    set_exertion(lane, so_far);
  }

  /// Takes back a step whose coefficients left the range of single precision, for another in a thousandth of its unit.
  /// @return false, with the lane's cause set, when that cannot be what is wrong
  bool retry(int lane) {
    const auto [lanes, i] = place(lane);
    StepMotion<double> motion;
    take_lane(lanes, i, motion);
    const auto& [first, second] = motion.joint;
    lanes.E[i] = first.start;
    lanes.q2[i] = second.start;
    lanes.V[i] = first.x[0] * first.rate;
    lanes.w[i] = second.x[0] * second.rate;
    lanes.t[i] = lanes.t_start[i];
    if constexpr (measured) lanes.done[i] = 0.0;
    set_unit(lane, 0x1p-10 / first.rate);
    if (lanes.unit[i] > 0x1p-50) return true;
    trials_[lane].cause = Cause::failure;
    return false;
  }

  double log2_tolerance_;
  std::uint64_t seated_{0};
  std::uint64_t armed_{0};               ///< lanes whose guards have all been positive in this phase
  std::uint64_t capped_{0};              ///< lanes whose phase has a ceiling
  static constexpr int most_guards = 3;  // of a phase
  Firings firings_{};
  LanesType packs_[pack_count]{};
  Trial trials_[pack_count * Pack::lanes]{};
};

}  // namespace steerstat::STEERSTAT_ISA
