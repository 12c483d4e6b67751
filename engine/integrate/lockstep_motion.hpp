// The motion of lanes within their last step, on the step's own polynomials. Included once by a source compiled for an
// instruction set, after the lanes; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

/// 1 / k, for k = 1 ... order + 1. The search's loops stay rolled: its code must not push the series' out of the cache.
inline constexpr std::array<double, order + 2> reciprocals = [] {
  std::array<double, order + 2> r{};
  for (std::size_t k = 1; k < r.size(); ++k) r[k] = 1.0 / static_cast<double>(k);
  return r;
}();

/// Places for lanes whose guards are looked at together: as many on every instruction set, so that the work is the
/// same.
inline constexpr int slots = 16;

/// One double a slot.
struct alignas(64) Slots {
  double slot[slots];
  double& operator[](int i) { return slot[i]; }
  double operator[](int i) const { return slot[i]; }
};

// What follows is written once, for one lane in doubles and for many slots in packs. A pack's slots start at `first`.
inline double load(double x, int /*first*/) {
  return x;
}
inline Pack load(const Slots& x, int first) {
  return load(x.slot + first);
}
inline double fma(double x, double y, double z) {
  return std::fma(x, y, z);
}
template <class Cell>
using Value = decltype(load(std::declval<const Cell&>(), 0));

/// One joint's motion over a lane's last step: a velocity's series, and the position it integrates to.
///
/// @tparam Cell  double, or Slots
template <class Cell>
struct JointSeries {
  Cell x[order + 1];  ///< coefficients of the velocity, in the series' units of time
  Cell rate;          ///< those units a second
  Cell start;         ///< position at the step's start
};

/// A joint's motion at a moment.
template <class Real>
struct Motion {
  Real position, velocity, acceleration, jerk, snap;

  /// The position and the velocity a little later, exact to rounding where `dt` is a ten-thousandth of a step.
  [[nodiscard]] Real position_after(Real dt) const {
    return fma(fma(fma(jerk, dt * Real(1.0 / 3.0), acceleration), Real(0.5) * dt, velocity), dt, position);
  }
  [[nodiscard]] Real velocity_after(Real dt) const {
    return fma(fma(fma(snap, dt * Real(1.0 / 3.0), jerk), Real(0.5) * dt, acceleration), dt, velocity);
  }
};

/// Both joints' motion at a moment.
template <class Real>
struct Moment {
  Real t;  ///< [s] since the step's start
  Motion<Real> joint[2];
};

/// The sums of one joint, a coefficient at a time.
template <class Real>
struct Horner {
  Real position, velocity, acceleration{0.0}, half_jerk{0.0}, sixth_snap{0.0};

  explicit Horner(Real last) : position(last * Real(reciprocals[order + 1])), velocity(last) {}

  void take(Real x, Real reciprocal, Real u) {
    sixth_snap = fma(sixth_snap, u, half_jerk);
    half_jerk = fma(half_jerk, u, acceleration);
    acceleration = fma(acceleration, u, velocity);
    velocity = fma(velocity, u, x);
    position = fma(position, u, x * reciprocal);
  }
  [[nodiscard]] Motion<Real> motion(Real rate, Real start, Real u) const {
    const Real rate2 = rate * rate;
    return {fma(position, u, start), velocity * rate, acceleration * rate2, Real(2.0) * half_jerk * (rate2 * rate),
            Real(6.0) * sixth_snap * (rate2 * rate2)};
  }
};

/// The motion of both joints over a lane's last step. Of a trial's guards, the first joint's watch align and the
/// second's drift.
///
/// @tparam Cell  double, or Slots
template <class Cell>
struct StepMotion {
  JointSeries<Cell> joint[2];

  /// Both joints at once: each sum waits for itself, and ten of them take little longer than one.
  ///
  /// @param t  [s] since the step's start
  [[gnu::noinline]] void at(Value<Cell> t, Moment<Value<Cell>>& out, int first = 0) const {
    using Real = Value<Cell>;
    const JointSeries<Cell>&one = joint[0], &two = joint[1];
    const Real rate = load(one.rate, first), u = t * rate;
    Horner<Real> sums_of_one(load(one.x[order], first)), sums_of_two(load(two.x[order], first));
    for (int k = order - 1; k >= 0; --k) {
      const Real reciprocal(reciprocals[static_cast<std::size_t>(k) + 1]);
      sums_of_one.take(load(one.x[k], first), reciprocal, u);
      sums_of_two.take(load(two.x[k], first), reciprocal, u);
    }
    out.t = t;
    out.joint[0] = sums_of_one.motion(rate, load(one.start, first), u);
    out.joint[1] = sums_of_two.motion(rate, load(two.start, first), u);
  }
};

/// One lane's series, out of all, to doubles `stride` apart.
template <int precision>
[[gnu::noinline]] void take_lane(const Pack (&x)[precision], const Single (&x_short)[order + 1], int lane, double* out,
                                 std::size_t stride = 1) {
  const auto* wide = reinterpret_cast<const char*>(x) + static_cast<std::size_t>(lane) * sizeof(double);
  const auto* narrow = reinterpret_cast<const char*>(x_short) + static_cast<std::size_t>(lane) * sizeof(float);
  for (std::size_t k = 0; k < precision; ++k) std::memcpy(&out[k * stride], wide + k * sizeof(Pack), sizeof(double));
  for (std::size_t k = precision; k <= order; ++k) {
    float coefficient = 0.0f;
    std::memcpy(&coefficient, narrow + k * sizeof(Single), sizeof(float));
    out[k * stride] = static_cast<double>(coefficient);
  }
}
template <int precision>
void take_lane(const Lanes<precision>& lanes, int lane, StepMotion<double>& out) {
  JointSeries<double>&first = out.joint[0], &second = out.joint[1];
  take_lane(lanes.series.V, lanes.series.V_short, lane, first.x);
  take_lane(lanes.series.w, lanes.series.w_short, lane, second.x);
  first.rate = second.rate = lanes.rate_start[lane];
  first.start = lanes.E_start[lane];
  second.start = lanes.q2_start[lane];
}
template <int precision>
void take_lane(const Lanes<precision>& lanes, int lane, StepMotion<Slots>& out, int slot) {
  JointSeries<Slots>&first = out.joint[0], &second = out.joint[1];
  take_lane(lanes.series.V, lanes.series.V_short, lane, first.x[0].slot + slot, slots);
  take_lane(lanes.series.w, lanes.series.w_short, lane, second.x[0].slot + slot, slots);
  first.rate[slot] = second.rate[slot] = lanes.rate_start[lane];
  first.start[slot] = lanes.E_start[lane];
  second.start[slot] = lanes.q2_start[lane];
}

/// A joint's series where it lies: coefficients `stride` doubles apart.
struct SeriesView {
  const double* x;
  std::size_t stride;
  double rate, start;  ///< of JointSeries
};
inline SeriesView view(const JointSeries<double>& joint) {
  return {joint.x, 1, joint.rate, joint.start};
}
inline SeriesView view(const JointSeries<Slots>& joint, int slot) {
  return {joint.x[0].slot + slot, slots, joint.rate[slot], joint.start[slot]};
}

/// A joint's motion sampled at the ends of a span's 16 equal parts; 16 at every lane count.
struct Samples {
  static constexpr int parts = 16;

  /// A quantity at the parts' ends.
  class Track {
   public:
    /// Where part i starts; i = parts: where the last one ends.
    double& operator[](int i) { return value_[i + 7]; }
    double operator[](int i) const { return value_[i + 7]; }
    /// Where the parts i ... start, and where they end.
    [[nodiscard]] Pack starts(int i) const { return load_anywhere(value_ + i + 7); }
    [[nodiscard]] Pack ends(int i) const { return load(value_ + i + 8); }
    void set_ends(int i, Pack x) { store(value_ + i + 8, x); }

   private:
    alignas(64) double value_[parts + 8];
  };

  Track position, velocity;
  double from, width;  ///< [s] since the step's start, and of the span

  /// [s] Where part i starts.
  [[nodiscard]] double t(int i) const { return std::fma(i * (1.0 / parts), width, from); }
};

/// Samples [from, from + width].
///
/// @param position, velocity  at `from`
[[gnu::noinline]] inline void sample(const SeriesView& joint, double from, double width, double position,
                                     double velocity, Samples& out) {
  alignas(64) static constexpr double ends[Samples::parts] = {
      1.0 / 16, 2.0 / 16,  3.0 / 16,  4.0 / 16,  5.0 / 16,  6.0 / 16,  7.0 / 16,  8.0 / 16,
      9.0 / 16, 10.0 / 16, 11.0 / 16, 12.0 / 16, 13.0 / 16, 14.0 / 16, 15.0 / 16, 1.0};
  out.from = from;
  out.width = width;
  out.position[0] = position;
  out.velocity[0] = velocity;
  for (int i = 0; i < Samples::parts; i += Pack::lanes) {
    const Pack u = fma(load(ends + i), Pack(width), Pack(from)) * Pack(joint.rate);
    Pack v(joint.x[order * joint.stride]);
    Pack p = v * Pack(reciprocals[order + 1]);
    for (int k = order - 1; k >= 0; --k) {
      const Pack x(joint.x[static_cast<std::size_t>(k) * joint.stride]);
      v = fma(v, u, x);
      p = fma(p, u, x * Pack(reciprocals[static_cast<std::size_t>(k) + 1]));
    }
    out.velocity.set_ends(i, v * Pack(joint.rate));
    out.position.set_ends(i, fma(p, u, Pack(joint.start)));
  }
}

}  // namespace steerstat::STEERSTAT_ISA
