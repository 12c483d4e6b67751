// Prints, for each figure of the paper's two experiments, what the paper says, what the trial's definition
// (CONTROLLER.md section 7) says, what this engine gives, and how far the last two are apart.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.hpp"
#include "exit_code.hpp"
#include "output.hpp"
#include "spec_file.hpp"
#include "study/plan.hpp"
#include "trial/replay.hpp"

namespace steerstat {
namespace {

// How far a figure may be from the definition's.
constexpr double time_tolerance = 0.02;   // [s]
constexpr double state_tolerance = 1e-4;  // [rad], [rad/s]
constexpr double count_tolerance = 0.0;

/// One line of the table.
struct Figure {
  std::string_view name;
  std::string_view unit;
  std::string_view paper;  ///< as printed there, "" where it says nothing
  double defined;
  double ours;
  double tolerance;
  int decimals;

  [[nodiscard]] bool agrees() const { return std::abs(ours - defined) <= tolerance; }
};

struct Course {
  TrajectorySample aligned;      ///< the end of the first alignment
  TrajectorySample contracting;  ///< the start of the first contraction: the end of the transition
  TrialOutcome outcome;
};

/// Runs the single trial of a spec. @throws RunFailure where it does not contract at all
Course course_of(const std::filesystem::path& spec) {
  const Study study = read_study(spec.string());
  const Trajectory trajectory = replay(Plan(study).parameters(0), study.integrator);
  std::optional<TrajectorySample> aligned;
  bool aligning = true;
  for (const TrajectorySample& sample : trajectory.samples) {
    aligning = aligning && sample.phase == PhaseKind::align;
    if (aligning) aligned = sample;
    if (sample.phase == PhaseKind::contraction && aligned) return {*aligned, sample, trajectory.outcome};
  }
  throw RunFailure(fmt::format("the trial of {} never contracts", spec.string()));
}

void append_table(std::string& text, std::string_view title, const std::vector<Figure>& figures) {
  text += fmt::format("{}\n{:32}{:>10}{:>12}{:>12}{:>12}  {}\n", title, "", "paper", "defined", "ours", "difference",
                      "unit");
  for (const Figure& figure : figures) {
    text += fmt::format("  {:30}{:>10}{:>12.{}f}{:>12.{}f}{:>+12.{}f}  {}{}\n", figure.name, figure.paper,
                        figure.defined, figure.decimals, figure.ours, figure.decimals, figure.ours - figure.defined,
                        figure.decimals, figure.unit, figure.agrees() ? "" : "  OUTSIDE THE TOLERANCE");
  }
}

std::vector<Figure> nominal_figures(const Course& course) {
  const TrialOutcome& end = course.outcome;
  return {
      {"end of the alignment, T1", "s", "3.4", 3.40, course.aligned.t, time_tolerance, 3},
      {"q2_dot there", "rad/s", "0.06", 0.0659, course.aligned.state.q2_dot, state_tolerance, 5},
      {"end of the transition", "s", "14.9", 14.90, course.contracting.t, time_tolerance, 3},
      {"q2 there", "rad", "pi/8", 0.3927, course.contracting.state.q2, state_tolerance, 5},
      {"contraction cycles", "", "9", 9.0, static_cast<double>(end.cycles), count_tolerance, 0},
      {"duration of the cycles", "s", "32.6", 32.37, end.end_time - course.contracting.t, time_tolerance, 3},
      {"end", "s", "", 47.270, end.end_time, time_tolerance, 3},
      {"q2 at the end", "rad", "", 0.78115, end.end_state.q2, state_tolerance, 5},
      {"q2_dot at the end", "rad/s", "", 5.66e-4, end.end_state.q2_dot, state_tolerance, 6},
  };
}

std::vector<Figure> friction_figures(const Course& course) {
  const TrialOutcome& end = course.outcome;
  return {
      {"end of the transition", "s", "18.3", 18.27, course.contracting.t, time_tolerance, 3},
      {"contraction cycles", "", "7", 7.0, static_cast<double>(end.cycles), count_tolerance, 0},
      {"duration of the cycles", "s", "49.2", 48.43, end.end_time - course.contracting.t, time_tolerance, 3},
      {"end", "s", "", 66.700, end.end_time, time_tolerance, 3},
      {"q2 at the end", "rad", "", 0.78217, end.end_state.q2, state_tolerance, 5},
      {"q2_dot at the end", "rad/s", "", 7.39e-4, end.end_state.q2_dot, state_tolerance, 6},
  };
}

ExitCode compare_with_the_paper(const std::filesystem::path& specs) {
  const std::vector<Figure> nominal = nominal_figures(course_of(specs / "nominal.json"));
  const std::vector<Figure> friction = friction_figures(course_of(specs / "friction.json"));
  std::string text;
  append_table(text, "Nominal plant, no friction (section 5 of the paper)", nominal);
  text += '\n';
  append_table(text, "Friction, f1 = f2 = 0.02, realigned after every cycle", friction);
  const auto agrees = [](const Figure& figure) { return figure.agrees(); };
  const bool all =
      std::all_of(nominal.begin(), nominal.end(), agrees) && std::all_of(friction.begin(), friction.end(), agrees);
  text += fmt::format(
      "\n\"defined\" is CONTROLLER.md's figure: counts must equal it, times be within {} s, states within {}.\n",
      time_tolerance, state_tolerance);
  print(text);
  return all ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace
}  // namespace steerstat

/// Usage: paper_table [DIRECTORY with nominal.json and friction.json]
int main(int argc, char** argv) {
  using namespace steerstat;
  ExitCode code = ExitCode::run_failed;
  try {
    secure_standard_streams();
    code = compare_with_the_paper(argc > 1 ? argv[1] : STEERSTAT_PAPER_SPECS);
  } catch (const BadUsage& bad) {
    tell_raw(fmt::format("paper_table: {}\n", bad.what()));
    code = ExitCode::bad_request;
  } catch (const std::exception& failure) {
    tell_raw(fmt::format("paper_table: {}\n", failure.what()));
  }
  return static_cast<int>(code);
}
