// Prints the course of one contraction cycle beside that of its nilpotent approximation (9), for the paper's Fig. 2, as
// CSV: t, q2, q2_dot, approximate_q2, approximate_q2_dot.

#include <fmt/format.h>

#include <numbers>
#include <string>

#include "core/errors.hpp"
#include "exit_code.hpp"
#include "output.hpp"
#include "trial/cycle_error.hpp"

namespace steerstat {
namespace {

/// From where the paper's nominal run begins to contract (§5), with the period of Fig. 2, T = 2 s. The figure does not
/// say its amplitude; at 100 m the approximation can be told from the robot.
constexpr Cycle cycle{std::numbers::pi / 8, 0.066, 100.0, 2.0};

ExitCode print_course() {
  std::string text = "t,q2,q2_dot,approximate_q2,approximate_q2_dot\n";
  for (const CycleComparison::Moment& m : CycleComparison({}, 1e-10).course_of(cycle, 200)) {
    text += fmt::format("{},{},{},{},{}\n", m.t, m.q2, m.q2_dot, m.approximate_q2, m.approximate_q2_dot);
  }
  print(text);
  return ExitCode::done;
}

}  // namespace
}  // namespace steerstat

int main() {
  using namespace steerstat;
  try {
    secure_standard_streams();
    return static_cast<int>(print_course());
  } catch (const std::exception& failure) {
    tell_raw(fmt::format("paper_cycle: {}\n", failure.what()));
    return static_cast<int>(ExitCode::run_failed);
  }
}
