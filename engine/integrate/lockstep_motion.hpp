// The motion of one lane within its last step, on the step's own polynomials. Included once by a source compiled for an
// instruction set, after the lanes; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// 1 / k, for k = 1 ... order + 1. The search's loops stay rolled: its code must not push the series' out of the cache.
inline constexpr std::array<double, order + 2> reciprocals = [] {
  std::array<double, order + 2> r{};
  for (std::size_t k = 1; k < r.size(); ++k) r[k] = 1.0 / static_cast<double>(k);
  return r;
}();

/// One joint's motion over a lane's last step: a velocity's series, and the position it integrates to.
struct JointSeries {
  double x[order + 1];  ///< coefficients of the velocity, in the series' units of time
  double rate;          ///< those units a second
  double start;         ///< position at the step's start
};

/// A joint's motion at a moment.
struct Motion {
  double position, velocity, acceleration, jerk, snap;

  /// The motion a little later, exact to rounding where `dt` is a ten-thousandth of a step.
  [[nodiscard]] Motion after(double dt) const {
    return {std::fma(std::fma(std::fma(jerk, dt * (1.0 / 3.0), acceleration), 0.5 * dt, velocity), dt, position),
            std::fma(std::fma(std::fma(snap, dt * (1.0 / 3.0), jerk), 0.5 * dt, acceleration), dt, velocity),
            acceleration, jerk, snap};
  }
};

/// The motion of both joints over a lane's last step. Of a trial's guards, the first joint's watch align and the
/// second's drift.
struct LaneMotion {
  JointSeries joint[2];

  struct Moment {
    double t;  ///< [s] since the step's start
    Motion joint[2];
  };
  /// Both joints at once: each sum waits for itself, and ten of them take little longer than one.
  ///
  /// @param t  [s] since the step's start
  [[gnu::noinline]] void at(double t, Moment& out) const {
    const double u = t * joint[0].rate;
    Horner first(joint[0]), second(joint[1]);
    for (int k = order - 1; k >= 0; --k) {
      first.take(joint[0].x[k], reciprocals[k + 1], u);
      second.take(joint[1].x[k], reciprocals[k + 1], u);
    }
    out = {t, {first.motion(joint[0], u), second.motion(joint[1], u)}};
  }

 private:
  /// The sums of one joint, a coefficient at a time.
  struct Horner {
    double position, velocity, acceleration{0.0}, half_jerk{0.0}, sixth_snap{0.0};

    explicit Horner(const JointSeries& joint)
        : position(joint.x[order] * reciprocals[order + 1]), velocity(joint.x[order]) {}

    void take(double x, double reciprocal, double u) {
      sixth_snap = std::fma(sixth_snap, u, half_jerk);
      half_jerk = std::fma(half_jerk, u, acceleration);
      acceleration = std::fma(acceleration, u, velocity);
      velocity = std::fma(velocity, u, x);
      position = std::fma(position, u, x * reciprocal);
    }
    [[nodiscard]] Motion motion(const JointSeries& joint, double u) const {
      const double rate = joint.rate, rate2 = rate * rate;
      return {std::fma(position, u, joint.start), velocity * rate, acceleration * rate2,
              2.0 * half_jerk * (rate2 * rate), 6.0 * sixth_snap * (rate2 * rate2)};
    }
  };
};

/// One lane's series, out of all.
template <int precision>
[[gnu::noinline]] void take_lane(const Pack (&x)[precision], const Single (&x_short)[order + 1], int lane,
                                 double (&out)[order + 1]) {
  const auto* wide = reinterpret_cast<const char*>(x) + static_cast<std::size_t>(lane) * sizeof(double);
  const auto* narrow = reinterpret_cast<const char*>(x_short) + static_cast<std::size_t>(lane) * sizeof(float);
  for (std::size_t k = 0; k < precision; ++k) std::memcpy(&out[k], wide + k * sizeof(Pack), sizeof(double));
  for (std::size_t k = precision; k <= order; ++k) {
    float coefficient = 0.0f;
    std::memcpy(&coefficient, narrow + k * sizeof(Single), sizeof(float));
    out[k] = static_cast<double>(coefficient);
  }
}
template <int precision>
void take_lane(const Lanes<precision>& lanes, int lane, LaneMotion& out) {
  JointSeries &first = out.joint[0], &second = out.joint[1];
  take_lane(lanes.series.V, lanes.series.V_short, lane, first.x);
  take_lane(lanes.series.w, lanes.series.w_short, lane, second.x);
  first.rate = second.rate = lanes.rate_start[lane];
  first.start = lanes.E_start[lane];
  second.start = lanes.q2_start[lane];
}

/// A joint's motion sampled at both ends of a span's 16 equal parts; 16 at every lane count.
struct Samples {
  static constexpr int parts = 16;
  struct alignas(64) Ends {
    double t[parts], position[parts], velocity[parts];
  };
  Ends before, after;
};

/// Samples [from, from + width].
[[gnu::noinline]] inline void sample(const JointSeries& joint, double from, double width, Samples& out) {
  alignas(64) static constexpr double sixteenths[Samples::parts] = {
      0.0,      1.0 / 16, 2.0 / 16,  3.0 / 16,  4.0 / 16,  5.0 / 16,  6.0 / 16,  7.0 / 16,
      8.0 / 16, 9.0 / 16, 10.0 / 16, 11.0 / 16, 12.0 / 16, 13.0 / 16, 14.0 / 16, 15.0 / 16};
  for (int i = 0; i < Samples::parts; i += Pack::lanes) {
    // Both ends of each part are evaluated, which is quicker than moving the results along by one place.
    const Pack part = load(sixteenths + i);
    const Pack t0 = fma(part, Pack(width), Pack(from));
    const Pack t1 = fma(part + Pack(1.0 / 16), Pack(width), Pack(from));
    const Pack x0 = t0 * Pack(joint.rate), x1 = t1 * Pack(joint.rate);
    Pack v0(joint.x[order]);
    Pack p0 = v0 * Pack(reciprocals[order + 1]);
    Pack v1 = v0, p1 = p0;
    for (int k = order - 1; k >= 0; --k) {
      const Pack x(joint.x[k]);
      const Pack integrated = x * Pack(reciprocals[k + 1]);
      v0 = fma(v0, x0, x);
      v1 = fma(v1, x1, x);
      p0 = fma(p0, x0, integrated);
      p1 = fma(p1, x1, integrated);
    }
    const Pack start(joint.start), rate(joint.rate);
    store(out.before.t + i, t0);
    store(out.before.velocity + i, v0 * rate);
    store(out.before.position + i, fma(p0, x0, start));
    store(out.after.t + i, t1);
    store(out.after.velocity + i, v1 * rate);
    store(out.after.position + i, fma(p1, x1, start));
  }
}

}  // namespace steerstat::STEERSTAT_ISA
