// What the kernels have in common: trials in the columns of packs. Included once by a source compiled for an
// instruction set, after the motion; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// Trials in the lanes of packs, and the phases that they are in.
///
/// @tparam PackLanes  the lanes of a pack: LaneRows and what a kernel adds
template <class PackLanes, int pack_count>
class PackedEngine : public LockstepEngine {
 public:
  [[nodiscard]] InstructionSet instruction_set() const final { return InstructionSet::STEERSTAT_ISA; }
  [[nodiscard]] int lanes() const final { return pack_count * Pack::lanes; }

  void vacate(int lane) final {
    const PlantParameters<double> any;
    seat(lane, {constants_of(any), constants_of(any), 0.0, 0.0, 0.0, {}, {}});
    start(lane, Phase{PhaseKind::drift}, 0.0, State<double>{}, 1.0);
    seated_ &= ~bit(lane);
  }

  [[nodiscard]] Arrival arrival(int lane) const final {
    const Trial& trial = trials_[lane];
    const auto [lanes, i] = place(lane);
    const double t = lanes.t[i];
    return {t == lanes.t_end[i] ? trial.t_end : trial.t_start + t,
            {trial.goal + lanes.E[i] / trial.K, lanes.q2[i], lanes.V[i] / trial.K, lanes.w[i]},
            trial.cause};
  }

 protected:
  void vacate_all() {
    for (int lane = 0; lane < lanes(); ++lane) vacate(lane);
  }

  struct Trial {
    ClosedLoop<double> loop;
    double K;
    double goal;  // where align sees it
    double t_start, t_end;
    Cause cause;
  };

  /// Where a lane's columns are.
  template <class L>
  struct Place {
    L& lanes;
    int column;
  };
  Place<PackLanes> place(int lane) { return {packs_[lane / Pack::lanes], lane % Pack::lanes}; }
  [[nodiscard]] Place<const PackLanes> place(int lane) const {
    return {packs_[lane / Pack::lanes], lane % Pack::lanes};
  }

  static std::uint64_t bit(int lane) { return std::uint64_t{1} << lane; }

  template <class Body>
  static void for_each_lane(std::uint64_t lanes, Body&& body) {
    for (; lanes != 0; lanes &= lanes - 1) body(std::countr_zero(lanes));
  }

  /// Gives a lane to a trial. @return its K
  double take_seat(int lane, const ClosedLoop<double>& loop) {
    Trial& trial = trials_[lane];
    trial.loop = loop;
    trial.K = loop.plant.moment / loop.plant.inertia;
    const auto [lanes, i] = place(lane);
    lanes.scale[i] = 1.0 / std::abs(trial.K);
    seated_ |= bit(lane);
    return trial.K;
  }

  /// Starts a phase but for what a kernel adds.
  ///
  /// @param read_V  align: what is read of V, less V
  /// @return        K A / T^2 of a cycle (11), else 0
  double begin(int lane, const Phase& phase, double t, const State<double>& x, double t_end, double read_V) {
    Trial& trial = trials_[lane];
    trial.goal = trial.loop.q1_goal - phase.q1_offset;
    trial.t_start = t;
    trial.t_end = t_end;
    trial.cause = Cause::time;
    const double K = trial.K;
    const double E = K * (x.q1 - trial.goal);
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
    const double factor = cycling ? K * phase.amplitude * rate * rate : 0.0;
    double power = factor;
    for (std::size_t k = 0; k < 5; ++k) {
      power *= rate;
      lanes.cycle[k][i] = cycle_coefficients[k] * power;
    }
    const double radius = phase.active_tolerance < 0.0 ? -1.0 : std::abs(K) * phase.active_tolerance;
    lanes.radius[i] = radius;
    const double ceiling = std::abs(K) * phase.ceiling;
    lanes.ceiling[i] = ceiling;
    lanes.q2_low[i] = phase.q2_low;
    lanes.q2_high[i] = phase.q2_high;
    lanes.direction[i] = phase.direction;
    lanes.speed_floor[i] = phase.speed_floor;
    const double seen_V = V + read_V;
    const bool armed = (radius < 0.0 || E * E + seen_V * seen_V > radius * radius) &&
                       std::abs(lanes.kp[i] * E + lanes.kd[i] * seen_V) < ceiling && x.q2 > phase.q2_low &&
                       x.q2 < phase.q2_high && phase.direction * x.q2_dot > phase.speed_floor;
    armed_ = (armed_ & ~bit(lane)) | (armed ? bit(lane) : 0);
    return factor;
  }

  void set_unit(int lane, double unit) {
    const auto [lanes, i] = place(lane);
    lanes.unit[i] = unit;
    lanes.rate[i] = 1.0 / unit;
  }

  /// What a step did, a bit a lane.
  struct StepEvents {
    std::uint64_t ended{0};  ///< phases
    std::uint64_t watch{0}, unsound{0}, stalled{0};

    void note(const StepReport& report, int pack) {
      ended |= at_pack(report.reached_end, pack);
      watch |= at_pack(report.watch, pack);
      unsound |= at_pack(report.unsound, pack);
      stalled |= at_pack(report.stalled, pack);
    }
  };
  static std::uint64_t at_pack(std::uint32_t bits, int pack) { return std::uint64_t{bits} << (pack * Pack::lanes); }

  /// Counts a step of all lanes, and leaves out what those without a trial did.
  void close_step(StepEvents& events) {
    counters_.steps += pack_count;
    counters_.lane_slots += static_cast<std::uint64_t>(lanes());
    counters_.lane_steps += static_cast<std::uint64_t>(std::popcount(seated_));
    for_each_lane(events.ended & ~seated_, [&](int lane) {
      const auto [lanes, i] = place(lane);
      lanes.t[i] = 0.0;
    });
    events.unsound &= seated_;
    const std::uint64_t counted = seated_ & ~events.unsound;
    events.ended &= counted;
    events.stalled &= counted;
  }

  /// Ends the phases of lanes whose steps have become too short.
  void fail_stalled(StepEvents& events) {
    for_each_lane(events.stalled, [&](int lane) { trials_[lane].cause = Cause::failure; });
    events.ended |= events.stalled;
  }

  /// Takes back a lane's step whose coefficients overflowed, for another in a thousandth of its unit.
  ///
  /// @param motion  over that step
  /// @return        false, with the lane's cause set, when that cannot be what is wrong
  bool take_back(int lane, const StepMotion<double>& motion) {
    const auto [lanes, i] = place(lane);
    const auto& [first, second] = motion.joint;
    lanes.E[i] = first.start;
    lanes.q2[i] = second.start;
    lanes.V[i] = first.x[0] * first.rate;
    lanes.w[i] = second.x[0] * second.rate;
    lanes.t[i] = lanes.t_start[i];
    set_unit(lane, 0x1p-10 / first.rate);
    if (lanes.unit[i] > 0x1p-50) return true;
    trials_[lane].cause = Cause::failure;
    return false;
  }

  /// A lane's state at a moment of its last step.
  [[nodiscard]] State<double> state_at(int lane, const StepMotion<double>& motion, double t) const {
    const Trial& trial = trials_[lane];
    const auto [lanes, i] = place(lane);
    Moment<double> moment;
    motion.at(t - (trial.t_start + lanes.t_start[i]), moment);
    const auto& [first, second] = moment.joint;
    return {trial.goal + first.position / trial.K, second.position, first.velocity / trial.K, second.velocity};
  }

  std::uint64_t seated_{0};
  std::uint64_t armed_{0};  ///< lanes whose guards have all been positive in this phase
  PackLanes packs_[pack_count]{};
  Trial trials_[pack_count * Pack::lanes]{};
};

}  // namespace steerstat::STEERSTAT_ISA
