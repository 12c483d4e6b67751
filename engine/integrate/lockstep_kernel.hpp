// The lockstep engine on one instruction set. Included once by a source compiled for it, after the guards; see
// core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

class Kernel final : public LockstepEngine {
 public:
  explicit Kernel(double tolerance) : log2_tolerance_(natural_log(margin * tolerance) * elementary::log2_e) {
    for (int lane = 0; lane < Pack::lanes; ++lane) vacate(lane);
  }

  [[nodiscard]] InstructionSet instruction_set() const override { return InstructionSet::STEERSTAT_ISA; }
  [[nodiscard]] int lanes() const override { return Pack::lanes; }

  void seat(int lane, const ClosedLoop<double>& loop) override {
    const PlantConstants<double>& plant = loop.plant;
    const PlantConstants<double>& nominal = loop.nominal;
    const double K = plant.moment / plant.inertia;
    Trial& trial = trials_[lane];
    trial.K = K;
    trial.loop = loop;
    lanes_.loop.slip[lane] = plant.f2 / plant.inertia;
    lanes_.loop.mismatch[lane] = K * (plant.moment - nominal.moment) / plant.mass;
    lanes_.loop.drive[lane] = nominal.mass / plant.mass;
    lanes_.loop.damping[lane] = plant.f1 / plant.mass;
    lanes_.loop.belief[lane] = K * nominal.moment / plant.mass;
    lanes_.loop.ratio[lane] = nominal.moment / nominal.inertia / K;
    lanes_.scale[lane] = 1.0 / std::abs(K);
    seated_ |= 1u << lane;
  }

  void start(int lane, const Phase& phase, double t, const State<double>& x, double t_end) override {
    Trial& trial = trials_[lane];
    trial.t_start = t;
    trial.t_end = t_end;
    trial.cause = Cause::time;
    const double K = trial.K;
    lanes_.E[lane] = K * (x.q1 - trial.loop.q1_goal);
    lanes_.V[lane] = K * x.q1_dot;
    lanes_.q2[lane] = x.q2;
    lanes_.w[lane] = x.q2_dot;
    lanes_.t[lane] = 0.0;
    lanes_.t_end[lane] = t_end - t;

    const bool aligning = phase.kind == PhaseKind::align;
    lanes_.kp[lane] = aligning ? -trial.loop.kp : 0.0;
    lanes_.kd[lane] = aligning ? -trial.loop.kd : 0.0;
    const bool cycling = phase.kind == PhaseKind::contraction || phase.kind == PhaseKind::swing;
    const double rate = cycling ? 1.0 / phase.duration : 0.0;
    double factor = cycling ? K * phase.amplitude * rate * rate : 0.0;  // (11)
    for (std::size_t i = 0; i < 5; ++i) {
      factor *= rate;
      lanes_.cycle[i][lane] = cycle_coefficients[i] * factor;
    }
    lanes_.radius[lane] = phase.active_tolerance < 0.0 ? -1.0 : std::abs(K) * phase.active_tolerance;
    lanes_.q2_low[lane] = phase.q2_low;
    lanes_.q2_high[lane] = phase.q2_high;
    lanes_.direction[lane] = phase.direction;
    lanes_.speed_floor[lane] = phase.speed_floor;
  }

  void vacate(int lane) override {
    const PlantParameters<double> any;
    seat(lane, {constants_of(any), constants_of(any), 0.0, 0.0, 0.0});
    start(lane, Phase{PhaseKind::drift}, 0.0, State<double>{}, 1.0);
    seated_ &= ~(1u << lane);
  }

  [[gnu::flatten]] std::uint32_t step() override {
    const StepReport report = advance(lanes_, log2_tolerance_);
    ++counters_.steps;
    counters_.lane_steps += static_cast<std::uint64_t>(std::popcount(seated_));
    for (std::uint32_t idle = report.reached_end & ~seated_; idle != 0; idle &= idle - 1) {
      lanes_.t[std::countr_zero(idle)] = 0.0;
    }
    std::uint32_t ended = (report.reached_end | report.failed) & seated_;
    for (std::uint32_t watch = report.watch & ~report.failed & seated_; watch != 0; watch &= watch - 1) {
      const int lane = std::countr_zero(watch);
      ++counters_.searches;
      const double t = locate_guard(lanes_, lane);
      if (t <= lanes_.h[lane]) {
        settle(lane, t);
        trials_[lane].cause = Cause::guard;
        ended |= 1u << lane;
      }
    }
    for (std::uint32_t failed = report.failed & seated_; failed != 0; failed &= failed - 1) {
      trials_[std::countr_zero(failed)].cause = Cause::failure;
    }
    counters_.arrivals += static_cast<std::uint64_t>(std::popcount(ended));
    return ended;
  }

  [[nodiscard]] Arrival arrival(int lane) const override {
    const Trial& trial = trials_[lane];
    const double t = lanes_.t[lane];
    return {t == lanes_.t_end[lane] ? trial.t_end : trial.t_start + t,
            {trial.loop.q1_goal + lanes_.E[lane] / trial.K, lanes_.q2[lane], lanes_.V[lane] / trial.K, lanes_.w[lane]},
            trial.cause};
  }

  [[nodiscard]] State<double> dense_output(int lane, double t) const override {
    const Trial& trial = trials_[lane];
    const double dt = t - (trial.t_start + lanes_.t_start[lane]);
    const JointSeries::Motion first = first_joint(lanes_, lane).at(dt);
    const JointSeries::Motion second = second_joint(lanes_, lane).at(dt);
    return {trial.loop.q1_goal + first.position / trial.K, second.position, first.velocity / trial.K, second.velocity};
  }

 private:
  /// Long trials amplify what a step gets wrong. With this share of the tolerance for a step's last terms, settling
  /// times of the combined study come out right to a hundred tolerances in the median.
  static constexpr double margin = 0.125;

  struct Trial {
    ClosedLoop<double> loop;
    double K;
    double t_start, t_end;
    Cause cause;
  };

  /// Puts a lane to t after its step's start.
  void settle(int lane, double t) {
    const JointSeries::Motion first = first_joint(lanes_, lane).at(t);
    const JointSeries::Motion second = second_joint(lanes_, lane).at(t);
    lanes_.E[lane] = first.position;
    lanes_.V[lane] = first.velocity;
    lanes_.q2[lane] = second.position;
    lanes_.w[lane] = second.velocity;
    lanes_.t[lane] = lanes_.t_start[lane] + t;
  }

  double log2_tolerance_;
  std::uint32_t seated_{0};
  Lanes lanes_{};
  Trial trials_[Pack::lanes]{};
};

}  // namespace steerstat::STEERSTAT_ISA
