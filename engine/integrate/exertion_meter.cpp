#include "integrate/exertion_meter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/elementary.hpp"

namespace steerstat {
namespace {

/// Where a step is looked at, as fractions of it: its ends and the nodes of Gauss and Legendre's rule between them.
constexpr std::size_t places = 6;
constexpr std::array<double, places> fractions{
    0.0, 0.06943184420297371239, 0.33000947820757186760, 0.66999052179242813240, 0.93056815579702628761, 1.0};
constexpr std::array<double, places> weights{
    0.0, 0.17392742256872692869, 0.32607257743127307131, 0.32607257743127307131, 0.17392742256872692869, 0.0};

/// By how much a function with three values y at rising x may exceed the largest of them between the outer two: twice
/// what their parabola does and, where its vertex is near, as much as it bends over the shorter gap; 0 where it has no
/// summit near.
double hidden_summit(const double* x, const double* y) {
  const double left = (y[1] - y[0]) / (x[1] - x[0]);
  const double right = (y[2] - y[1]) / (x[2] - x[1]);
  const double second = (right - left) / (x[2] - x[0]);
  const double gap = std::min(x[1] - x[0], x[2] - x[1]);
  const double vertex = 0.5 * (x[0] + x[1] - left / second);
  if (!(second < 0.0) || !(x[0] - gap < vertex && vertex < x[2] + gap)) return 0.0;
  const double top = std::clamp(vertex, x[0], x[2]);
  const double height = y[0] + (top - x[0]) * (left + (top - x[1]) * second);
  return 2.0 * (height - std::max({y[0], y[1], y[2]})) - second * gap * gap;
}

/// The largest value of `f` on [low, high], where it has one summit: by golden sections, to 1e-8 of its bend there.
template <class Function>
double climb(const Function& f, double low, double high) {
  constexpr double golden = 0.61803398874989484820;
  double x1 = high - golden * (high - low);
  double x2 = low + golden * (high - low);
  double y1 = f(x1);
  double y2 = f(x2);
  for (int i = 0; i < 20; ++i) {
    if (y1 > y2) {
      high = x2;
      x2 = x1;
      y2 = y1;
      x1 = high - golden * (high - low);
      y1 = f(x1);
    } else {
      low = x1;
      x1 = x2;
      y1 = y2;
      x2 = low + golden * (high - low);
      y2 = f(x2);
    }
  }
  return std::max(y1, y2);
}

/// Raises `peak` to the largest value of `f` in a step, sampled at `y`.
///
/// @param t, y  (places) @param f  of t
template <class Function>
void raise(double& peak, const std::array<double, places>& t, const std::array<double, places>& y, const Function& f) {
  const auto highest = static_cast<std::size_t>(std::max_element(y.begin(), y.end()) - y.begin());
  peak = std::max(peak, y[highest]);
  const std::size_t first = std::clamp<std::size_t>(highest, 1, places - 2) - 1;
  const double possible = y[highest] + hidden_summit(&t[first], &y[first]);
  if (possible > peak * (1.0 + 1e-9)) peak = std::max(peak, climb(f, t[first], t[first + 2]));
}

}  // namespace

ExertionMeter::ExertionMeter(const ClosedLoop<double>& loop, const Phase& phase, double t, Exertion& exertion)
    : loop_(loop), phase_(phase), phase_start_(t), exertion_(exertion) {}

ExertionMeter::Load ExertionMeter::load(double t, const State<double>& x) const {
  const double a = commanded_acceleration(loop_, phase_, t - phase_start_, x);
  const auto [s, c] = sincos(x.q2);
  const double tau = driving_force(loop_, a, x, s, c);
  return {std::abs(a), std::abs(tau), std::abs(x.q1 - loop_.q1_goal)};
}

/// Into how many equal parts a step is cut, so that a few places tell the force in each: an integrator may stride over
/// turns of link 2, or over a whole cycle, where its own error does not grow by it.
int ExertionMeter::parts(double width, const State<double>& before, const State<double>& after) const {
  constexpr double turn = 0.6;      // [rad]
  constexpr double period = 0.05;   // of a cycle
  constexpr double response = 0.5;  // of an align's time
  constexpr double most = 64.0;     // more are of an align's response that has died down
  double count = width * std::max(std::abs(before.q2_dot), std::abs(after.q2_dot)) / turn;
  if (phase_.duration < Phase::unbounded) count = std::max(count, width / (period * phase_.duration));
  if (phase_.kind == PhaseKind::align) {
    count = std::max(count, width * std::max(std::sqrt(loop_.kp), loop_.kd) / response);
  }
  return count < most ? static_cast<int>(count) + 1 : static_cast<int>(most);
}

void ExertionMeter::step(double from, double to, const DenseOutput& output) {
  const int count = parts(to - from, output.at(from), output.at(to));
  const double width = (to - from) / count;
  for (int i = 0; i < count; ++i) {
    const double start = from + i * width;
    measure(start, i + 1 == count ? to : start + width, output);
  }
}

/// Measures a part of a step.
void ExertionMeter::measure(double from, double to, const DenseOutput& output) {
  std::array<double, places> t{}, acceleration{}, force{}, stroke{};
  double squares = 0.0;
  for (std::size_t i = 0; i < places; ++i) {
    t[i] = from + fractions[i] * (to - from);
    const Load now = load(t[i], output.at(t[i]));
    acceleration[i] = now.acceleration;
    force[i] = now.force;
    stroke[i] = now.stroke;
    squares += weights[i] * (now.force * now.force);
  }
  exertion_.effort += (to - from) * squares;
  raise(exertion_.peak_acceleration, t, acceleration, [&](double at) { return load(at, output.at(at)).acceleration; });
  raise(exertion_.peak_force, t, force, [&](double at) { return load(at, output.at(at)).force; });
  raise(exertion_.peak_stroke, t, stroke, [&](double at) { return load(at, output.at(at)).stroke; });
}

}  // namespace steerstat
