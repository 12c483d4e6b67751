// The lockstep engine on one instruction set. Included once by a source compiled for it, after the packed engine; see
// core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// Packs advanced one after another before anyone looks at what has ended, so that code and branch history stay warm.
inline constexpr int pack_count = 4;

template <int precision, bool measured>
using KernelLanes = std::conditional_t<measured, MeasuredLanes<precision>, Lanes<precision>>;

/// Trials without imperfections.
///
/// @tparam measured  whether trials' exertion is measured
template <int precision, bool measured>
class Kernel final : public PackedEngine<KernelLanes<precision, measured>, pack_count> {
  using Base = PackedEngine<KernelLanes<precision, measured>, pack_count>;
  using Base::armed_, Base::at_pack, Base::bit, Base::counters_, Base::for_each_lane, Base::packs_, Base::place,
      Base::seated_, Base::trials_;
  using typename Base::StepEvents, typename Base::Trial;

 public:
  explicit Kernel(double tolerance) : log2_tolerance_(natural_log(margin * tolerance) * elementary::log2_e) {
    Base::vacate_all();
  }

  void seat(int lane, const ClosedLoop<double>& loop) override {
    const PlantConstants<double>& plant = loop.plant;
    const PlantConstants<double>& nominal = loop.nominal;
    const double K = Base::take_seat(lane, loop);
    const auto [lanes, i] = place(lane);
    lanes.loop.slip[i] = plant.f2 / plant.inertia;
    lanes.loop.mismatch[i] = K * (plant.moment - nominal.moment) / plant.mass;
    lanes.loop.drive[i] = nominal.mass / plant.mass;
    lanes.loop.damping[i] = plant.f1 / plant.mass;
    lanes.loop.belief[i] = K * nominal.moment / plant.mass;
    lanes.loop.ratio[i] = nominal.moment / nominal.inertia / K;
    if constexpr (measured) lanes.force_unit[i] = plant.mass / std::abs(K);
    set_exertion(lane, Exertion{});
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
    const double factor = Base::begin(lane, phase, t, x, t_end, 0.0);
    if constexpr (measured) {
      const auto [lanes, i] = place(lane);
      phases_[lane] = {phase, std::abs(factor) * lanes.scale[i] * (cycle_peak * (1.0 + 1e-12))};
    }
    capped_ = (capped_ & ~bit(lane)) | (phase.ceiling < Phase::unbounded ? bit(lane) : 0);
  }

  std::uint64_t step() override {
    StepReport reports[pack_count];
    advance(packs_, log2_tolerance_, reports);
    StepEvents events;
    for (int pack = 0; pack < pack_count; ++pack) {
      events.note(reports[pack], pack);
      if ((capped_ & at_pack(all_lanes, pack)) != 0) events.watch |= at_pack(may_reach_ceiling(packs_[pack]), pack);
    }
    Base::close_step(events);
    events.ended |= search(events.watch & seated_ & ~events.unsound);
    armed_ |= ~events.watch;  // every guard of these was positive throughout
    Base::fail_stalled(events);
    for_each_lane(events.unsound, [&](int lane) {
      if (!retry(lane)) events.ended |= bit(lane);
    });
    if constexpr (measured) measure_step(events.ended);
    counters_.arrivals += static_cast<std::uint64_t>(std::popcount(events.ended));
    return events.ended;
  }

  [[nodiscard]] State<double> dense_output(int lane, double t) const override {
    const auto [lanes, i] = place(lane);
    StepMotion<double> motion;
    take_lane(lanes, i, motion);
    return Base::state_at(lane, motion, t);
  }

 private:
  /// Long trials amplify what a step gets wrong. With this share of the tolerance for a step's last terms, settling
  /// times of the combined study come out right to a hundred tolerances in the median.
  static constexpr double margin = 0.125;
  static constexpr std::uint32_t all_lanes = ~std::uint32_t{0} >> (32 - Pack::lanes);  // of a pack

  /// A lane's phase, where it is measured.
  struct MeasuredPhase {
    Phase phase;
    double cycle_bound;  // of a cycle's |a|; 0 in another phase
  };

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
      const auto& [phase, cycle_bound] = phases_[lane];
      const auto [lanes, i] = place(lane);
      if (cycle_bound <= lanes.peak_acceleration[i]) return;
      const double peak = Base::peak_of_cycle(phase, lanes.t[i]);
      lanes.peak_acceleration[i] = std::max(lanes.peak_acceleration[i], peak);
    });
  }

  /// Measures a lane's last step where packs cannot.
  void measure_in_parts(int lane) {
    const Trial& trial = trials_[lane];
    const auto [lanes, i] = place(lane);
    const double from = trial.t_start + lanes.t_start[i];
    Exertion so_far = exertion(lane);
    Base::meter(trial.loop, phases_[lane].phase, trial.t_start, from, from + lanes.done[i], lane, so_far);
    set_exertion(lane, so_far);
  }

  /// Takes back a step whose coefficients left the range of single precision; as take_back.
  bool retry(int lane) {
    const auto [lanes, i] = place(lane);
    StepMotion<double> motion;
    take_lane(lanes, i, motion);
    if constexpr (measured) lanes.done[i] = 0.0;
    return Base::take_back(lane, motion);
  }

  double log2_tolerance_;
  std::uint64_t capped_{0};              ///< lanes whose phase has a ceiling
  static constexpr int most_guards = 3;  // of a phase
  Firings firings_{};
  MeasuredPhase phases_[measured ? pack_count * Pack::lanes : 1]{};
};

}  // namespace steerstat::STEERSTAT_ISA
