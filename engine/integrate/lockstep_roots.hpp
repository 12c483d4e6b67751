// The roots of guards between samples, in many lanes at once. Included once by a source compiled for an instruction
// set, after the guards; see core/instruction_set.hpp.

namespace steerstat::STEERSTAT_ISA {

// For one lane in doubles, what packs have.
inline double abs(double x) {
  return std::abs(x);
}
inline double min(double x, double y) {
  return x < y ? x : y;
}
inline double max(double x, double y) {
  return x > y ? x : y;
}
inline double select(bool m, double x, double y) {
  return m ? x : y;
}
inline std::uint32_t bits(bool m) {
  return m ? 1 : 0;
}

/// GuardTerms as a function, with its derivatives along the motion.
template <class Real>
struct GuardFunction {
  using Truth = decltype(Real(0.0) < Real(1.0));
  Truth second, round;
  Real by_position, by_velocity, offset;

  template <class Cell>
  GuardFunction(const GuardTerms<Cell>& terms, int first)
      : second(Real(0.0) < load(terms.joint, first)),
        round(Real(0.0) < load(terms.round, first)),
        by_position(load(terms.by_position, first)),
        by_velocity(load(terms.by_velocity, first)),
        offset(load(terms.offset, first)) {}

  [[nodiscard]] Motion<Real> watched(const Moment<Real>& moment) const {
    const auto& [one, two] = moment.joint;
    return {select(second, two.position, one.position), select(second, two.velocity, one.velocity),
            select(second, two.acceleration, one.acceleration), select(second, two.jerk, one.jerk), one.snap};
  }
  [[nodiscard]] Real value(const Motion<Real>& m) const {
    return fma(select(round, m.position, by_position), m.position,
               select(round, m.velocity, by_velocity) * m.velocity) +
           offset;
  }
  [[nodiscard]] Real rate(const Motion<Real>& m) const {
    return select(round, Real(2.0) * m.velocity * (m.position + m.acceleration),
                  fma(by_position, m.velocity, by_velocity * m.acceleration));
  }
  [[nodiscard]] Real curvature(const Motion<Real>& m) const {
    return select(round,
                  Real(2.0) * (m.acceleration * (m.position + m.acceleration) + m.velocity * (m.velocity + m.jerk)),
                  fma(by_position, m.acceleration, by_velocity * m.jerk));
  }
};

/// A guard's root in (low, high], where it goes from positive to <= 0, to 1e-10 of the part and so to rounding in the
/// state: Halley's method kept in the bracket.
///
/// A guard that turns back may do so next to its root, or rise out of the bracket's end; changes are small there too.
///
/// @tparam G     a GuardFunction, or what has its functions
/// @param open   the lanes that have one; of the others the result says nothing
/// @param first  slot of the pack's first lane
/// @param near   becomes the motion at a moment next to the root
/// @return       the root [s] since the step's start
template <class Real, class Cell, class G, class Truth>
[[gnu::noinline]] Real refine(const G& guard, const StepMotion<Cell>& motion, const Bracket<Cell>& bracket, Truth open,
                              int first, Moment<Real>& near) {
  Real low = load(bracket.low, first), high = load(bracket.high, first);
  const Real g_low = load(bracket.g_low, first), g_high = load(bracket.g_high, first);
  const Real bend = load(bracket.bend, first);
  // The parabola through the bracket's ends, by one Newton step from the chord's root; in shares of the width.
  const Real width = high - low;
  const Real slope = g_high - g_low;
  const Real chord = -g_low / slope;
  const Real share = chord - Real(0.5) * bend * chord * (chord - Real(1.0)) / (slope + bend * (chord - Real(0.5)));
  const Truth plausible = (Real(0.0) < share) & (share < Real(1.0));
  Real t = select(low < high, fma(select(plausible, share, chord), width, low), low);
  Real root = high;
  Truth at_end = low < low;  // nowhere
  for (int i = 0; i < 60 && bits(open) != 0; ++i) {
    motion.at(t, near, first);
    const Motion<Real> watched = guard.watched(near);
    const Real g = guard.value(watched);
    const Truth before = Real(0.0) < g;
    low = select(before, t, low);
    high = select(before, high, t);
    const Real rate = guard.rate(watched), bent = g * guard.curvature(watched);
    const Real change = Real(2.0) * g * rate / (Real(2.0) * rate * rate - bent);
    const Real next = t - change;
    // Convergence is cubic: what is left after a change this small is 1e-8 of the part, times how curved it is,
    // squared.
    const Truth falls = (rate < Real(0.0)) & (abs(bent) <= rate * rate);
    const Truth close = falls & (abs(change) <= Real(2e-3) * width);
    root = select(open & close, min(max(next, low), high), root);
    open = open & !close;
    const Real middle = Real(0.5) * (low + high);
    const Truth inside = (low < next) & (next < high);
    const Truth splits = (low < middle) & (middle < high);
    at_end = at_end | (open & !inside & !splits);
    open = open & (inside | splits);
    t = select(open, select(inside, next, middle), t);
  }
  at_end = at_end | open;
  if (bits(at_end) != 0) {
    root = select(at_end, high, root);
    t = select(at_end, high, t);
    motion.at(t, near, first);
  }
  return root;
}

/// Lanes whose guards fire in their last steps. To find their roots together takes little longer than to find one.
struct Firings {
  StepMotion<Slots> motion;
  GuardTerms<Slots> guard;
  Bracket<Slots> bracket;
  int lane[slots];
  int count{0};

  Slots t, E, V, q2, w;  ///< where the guards fire; see locate()

  void add(int firing_lane, const GuardTerms<double>& terms, const Bracket<double>& found) {
    const int slot = count++;
    lane[slot] = firing_lane;
    guard.joint[slot] = terms.joint;
    guard.round[slot] = terms.round;
    guard.by_position[slot] = terms.by_position;
    guard.by_velocity[slot] = terms.by_velocity;
    guard.offset[slot] = terms.offset;
    bracket.low[slot] = found.low;
    bracket.high[slot] = found.high;
    bracket.g_low[slot] = found.g_low;
    bracket.g_high[slot] = found.g_high;
    bracket.bend[slot] = found.bend;
  }

  /// Finds the roots, and the states there.
  [[gnu::noinline]] void locate() {
    static constexpr Slots places{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}};
    for (int first = 0; first < count; first += Pack::lanes) {
      Moment<Pack> near;
      const Pack root =
          refine(GuardFunction<Pack>(guard, first), motion, bracket, load(places, first) < Pack(count), first, near);
      const Pack dt = root - near.t;
      const auto& [one, two] = near.joint;
      store(t.slot + first, root);
      store(E.slot + first, one.position_after(dt));
      store(V.slot + first, one.velocity_after(dt));
      store(q2.slot + first, two.position_after(dt));
      store(w.slot + first, two.velocity_after(dt));
    }
  }
};

}  // namespace steerstat::STEERSTAT_ISA
