// The lockstep engine for trials with imperfections on one instruction set. Included once by a source compiled for it,
// after the lanes and the packed engine; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// The guard of align on what is read: sqrt(E^2 + (V + read_V)^2) - radius.
struct ReadAlignGuard {
  static constexpr int joint = 0;
  double radius;
  double read_V;

  [[nodiscard]] Evidence judge(const Samples& s, double slack, double width) const {
    Evidence evidence;
    for (int i = 0; i < Samples::parts; i += Pack::lanes) {
      const Pack E0 = s.position.starts(i), V0 = s.velocity.starts(i) + Pack(read_V);
      const Pack E1 = s.position.ends(i), V1 = s.velocity.ends(i) + Pack(read_V);
      const Pack limit(radius * radius);
      const Mask out0 = limit < fma(E0, E0, V0 * V0);
      const Mask out1 = limit < fma(E1, E1, V1 * V1);
      const Mask quiet = chord_avoids(E0, V0, E1, V1, Pack(radius + slack) + position_slack(V0, V1, slack, width));
      evidence.crossing |= bits(out0 & !out1) << i;
      evidence.uncertain |= bits(out0 & out1 & !quiet) << i;
    }
    return evidence;
  }
  [[nodiscard]] double value(double position, double velocity) const {
    velocity += read_V;
    return std::fma(position, position, velocity * velocity) - radius * radius;
  }
  [[nodiscard]] static const Motion<double>& watched(const Moment<double>& moment) { return moment.joint[joint]; }
  [[nodiscard]] double value(const Motion<double>& m) const { return value(m.position, m.velocity); }
  [[nodiscard]] double rate(const Motion<double>& m) const {
    return 2.0 * (m.velocity * m.position + (m.velocity + read_V) * m.acceleration);
  }
  [[nodiscard]] double curvature(const Motion<double>& m) const {
    return 2.0 *
           (m.velocity * m.velocity + m.acceleration * (m.position + m.acceleration) + (m.velocity + read_V) * m.jerk);
  }
};

/// One: the series' sums keep the processor busy by themselves.
inline constexpr int imperfect_pack_count = 1;

/// Trials with any imperfection of engine/robot/README.md but the sensor's, which phases carry. Where the actuator's
/// limit is reached the loop has a kink: steps end there.
class ImperfectKernel final : public PackedEngine<ImperfectLanes, imperfect_pack_count> {
 public:
  explicit ImperfectKernel(double tolerance) : log2_tolerance_(natural_log(margin * tolerance) * elementary::log2_e) {
    vacate_all();
  }

  void seat(int lane, const ClosedLoop<double>& loop) override {
    const PlantConstants<double>& plant = loop.plant;
    const PlantConstants<double>& nominal = loop.nominal;
    const Disturbance<double>& disturbance = loop.disturbance;
    const double gain = loop.actuator.gain;
    const double K = take_seat(lane, loop);
    const auto [lanes, i] = place(lane);
    ImperfectConstants<Row>& constants = lanes.loop;
    constants.slip[i] = plant.f2 / plant.inertia;
    constants.damping[i] = plant.f1 / plant.mass;
    constants.pull[i] = K * plant.moment / plant.mass;
    constants.drive[i] = gain * nominal.mass / plant.mass;
    constants.belief[i] = K * gain * nominal.moment / plant.mass;
    constants.belief_b[i] = gain * nominal.moment * nominal.moment / nominal.inertia / plant.mass;
    constants.limit[i] = std::abs(K) * loop.actuator.max_force / plant.mass;
    constants.fall[i] = K * disturbance.gravity_x;
    constants.tilt[i] = K * disturbance.gravity_y;
    constants.rub1[i] = std::abs(K) * disturbance.coulomb1 / plant.mass;
    constants.rub2[i] = disturbance.coulomb2 / plant.inertia;
    constants.sharp1[i] = 1.0 / (std::abs(K) * disturbance.coulomb_speed1);
    constants.sharp2[i] = 1.0 / disturbance.coulomb_speed2;
    const bool rubs = disturbance.coulomb1 > 0.0 || disturbance.coulomb2 > 0.0;
    rubbing_ = (rubbing_ & ~bit(lane)) | (rubs ? bit(lane) : 0);
  }

  void start(int lane, const Phase& phase, double t, const State<double>& x, double t_end) override {
    const double read_V = trials_[lane].K * phase.q1_dot_offset;
    begin(lane, phase, t, x, t_end, read_V);
    corrected_at_[lane] = -1.0;
    const auto [lanes, i] = place(lane);
    lanes.read_V[i] = read_V;
    lanes.mode[i] = undecided;
  }

  std::uint64_t step() override {
    StepEvents events;
    std::uint64_t force = 0;
    for (int pack = 0; pack < imperfect_pack_count; ++pack) {
      const bool rubs = (rubbing_ >> (pack * Pack::lanes) & (~std::uint64_t{0} >> (64 - Pack::lanes))) != 0;
      const ImperfectReport report =
          rubs ? advance<true>(packs_[pack], log2_tolerance_) : advance<false>(packs_[pack], log2_tolerance_);
      events.note(report.step, pack);
      force |= at_pack(report.force, pack);
    }
    close_step(events);
    fail_stalled(events);
    for_each_lane((events.watch | force) & seated_ & ~events.unsound & ~events.stalled, [&](int lane) {
      switch (search(lane, (events.watch & bit(lane)) != 0, (force & bit(lane)) != 0)) {
        case Found::nothing:
          break;
        case Found::guard:
          events.ended |= bit(lane);
          break;
        case Found::kink:
          events.ended &= ~bit(lane);
          break;
      }
    });
    armed_ |= ~events.watch;  // every guard of these was positive throughout
    for_each_lane(events.unsound, [&](int lane) {
      if (!take_back(lane, motion_of(lane))) events.ended |= bit(lane);
    });
    counters_.arrivals += static_cast<std::uint64_t>(std::popcount(events.ended));
    return events.ended;
  }

  [[nodiscard]] State<double> dense_output(int lane, double t) const override {
    return state_at(lane, motion_of(lane), t);
  }

 private:
  static constexpr double margin = 0.125;  // as without imperfections

  enum class Found { nothing, guard, kink };

  static double coefficient(const Pack& x, int i) {
    double value = 0.0;
    std::memcpy(&value, reinterpret_cast<const char*>(&x) + static_cast<std::size_t>(i) * sizeof(double),
                sizeof(double));
    return value;
  }

  /// The motion over a lane's last step.
  [[nodiscard]] StepMotion<double> motion_of(int lane) const {
    const auto [lanes, i] = place(lane);
    StepMotion<double> motion;
    JointSeries<double>&first = motion.joint[0], &second = motion.joint[1];
    for (int k = 0; k <= order; ++k) {
      first.x[k] = coefficient(lanes.series.V[k], i);
      second.x[k] = coefficient(lanes.series.w[k], i);
    }
    first.rate = second.rate = lanes.rate_start[i];
    first.start = lanes.E_start[i];
    second.start = lanes.q2_start[i];
    return motion;
  }

  /// The force asked for over the last step, in the place of both velocities.
  static StepMotion<double> force_asked(const ImperfectLanes& lanes, int i) {
    StepMotion<double> motion;
    JointSeries<double>& force = motion.joint[DriftGuard::joint];
    for (int k = 0; k < order; ++k) force.x[k] = coefficient(lanes.series.D[k], i) * lanes.rate_start[i];
    force.x[order] = 0.0;
    force.rate = lanes.rate_start[i];
    force.start = 0.0;
    motion.joint[1 - DriftGuard::joint] = force;
    return motion;
  }

  /// When a guard first fires within a step of size h [s since its start]; infinite: never.
  template <class G>
  static double locate(const G& guard, const StepMotion<double>& motion, double h, double bend, bool armed) {
    const SeriesView joint = view(motion.joint[G::joint]);
    Samples samples;
    sample(joint, 0.0, h, joint.start, joint.x[0] * joint.rate, samples);
    Bracket<double> bracket;
    if (!bracket_crossing(guard, joint, samples, bend, armed, 0, bracket)) return Phase::unbounded;
    Moment<double> near;
    if constexpr (std::is_same_v<G, ReadAlignGuard>) {
      return refine(guard, motion, bracket, true, 0, near);
    } else {
      return refine(GuardFunction<double>(guard.terms(), 0), motion, bracket, true, 0, near);
    }
  }

  /// When a guard of the lane's phase first fires within its last step.
  [[nodiscard]] double locate_guard(int lane) const {
    const auto [lanes, i] = place(lane);
    const double h = lanes.h[i];
    const double bend = lanes.bend[i] / (h * h);
    const bool armed = (armed_ & bit(lane)) != 0;
    const StepMotion<double> motion = motion_of(lane);
    double t = Phase::unbounded;
    const auto consider = [&](const auto& guard, double bound) {
      if (std::abs(bound) < Phase::unbounded) t = std::min(t, locate(guard, motion, h, bend, armed));
    };
    if (lanes.radius[i] >= 0.0) {
      consider(ReadAlignGuard{lanes.radius[i], lanes.read_V[i]}, lanes.radius[i]);
      const double kp = lanes.kp[i], kd = lanes.kd[i], ceiling = lanes.ceiling[i];
      const double read = kd * lanes.read_V[i];  // what reading adds to b
      consider(CeilingGuard{kp, kd, 1.0, ceiling - read}, ceiling);
      consider(CeilingGuard{kp, kd, -1.0, ceiling + read}, ceiling);
      return t;
    }
    const auto consider_drift = [&](const DriftGuard& guard) { consider(guard, guard.bound); };
    consider_drift({false, 1.0, lanes.q2_low[i]});
    consider_drift({false, -1.0, -lanes.q2_high[i]});
    consider_drift({true, lanes.direction[i], lanes.speed_floor[i]});
    return t;
  }

  /// When the force asked for first crosses the limit within a lane's last step, and the mode that it goes on in.
  struct Kink {
    double t;
    double mode;
    bool wrong;  ///< no crossing, but the step's end is on the other side: the step was in the wrong mode
  };
  [[nodiscard]] Kink locate_kink(int lane) const {
    const auto [lanes, i] = place(lane);
    const double h = lanes.h[i];
    const double bend = lanes.force_bend[i] / (h * h);
    const double limit = lanes.loop.limit[i];
    const StepMotion<double> force = force_asked(lanes, i);
    Moment<double> end;
    force.at(h, end);
    const double last = end.joint[DriftGuard::joint].velocity;
    const double mode = lanes.mode[i];
    if (mode != within_limits) {
      const double t = locate(DriftGuard{true, mode, limit}, force, h, bend, false);
      return {t, within_limits, t > h && mode * last < limit};
    }
    const double upper = locate(DriftGuard{true, -1.0, -limit}, force, h, bend, false);
    const double lower = locate(DriftGuard{true, 1.0, -limit}, force, h, bend, false);
    const double t = std::min(upper, lower);
    const double side = t > h ? last : lower - upper;
    return {t, side > 0.0 ? at_upper_limit : at_lower_limit, t > h && std::abs(last) > limit};
  }

  /// Looks for what may have happened to a lane within its last step, and puts it there.
  Found search(int lane, bool watch, bool force) {
    ++counters_.searches;
    const auto [lanes, i] = place(lane);
    const double guard = watch ? locate_guard(lane) : Phase::unbounded;
    if (force) {
      const Kink kink = locate_kink(lane);
      if (kink.t < guard && kink.t <= lanes.h[i]) {
        put(lane, kink.t);
        lanes.mode[i] = kink.mode;
        return Found::kink;
      }
      // Once at a time: where the force only touches the limit, rounding may call either mode wrong.
      if (kink.wrong && corrected_at_[lane] != lanes.t_start[i]) {
        corrected_at_[lane] = lanes.t_start[i];
        put(lane, 0.0);
        lanes.mode[i] = kink.mode;
        return Found::kink;
      }
    }
    if (!(guard <= lanes.h[i])) return Found::nothing;
    put(lane, guard);
    trials_[lane].cause = Cause::guard;
    return Found::guard;
  }

  /// Puts a lane to t [s] after its last step's start.
  void put(int lane, double t) {
    const auto [lanes, i] = place(lane);
    Moment<double> moment;
    motion_of(lane).at(t, moment);
    const auto& [first, second] = moment.joint;
    lanes.E[i] = first.position;
    lanes.V[i] = first.velocity;
    lanes.q2[i] = second.position;
    lanes.w[i] = second.velocity;
    lanes.t[i] = lanes.t_start[i] + t;
  }

  double log2_tolerance_;
  std::uint64_t rubbing_{0};                                   ///< lanes with Coulomb friction
  double corrected_at_[imperfect_pack_count * Pack::lanes]{};  ///< [s] since the phase's start: when its force's mode
                                                               ///< was last found to be wrong; negative: never
};

}  // namespace steerstat::STEERSTAT_ISA
