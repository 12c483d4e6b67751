// Prints, for each figure of the paper's two experiments (section 5), what the paper says, what a reference computation
// of the same trial gives (CONTROLLER.md section 7: an 8th-order integrator at 1e-10), what this engine gives, and how
// far it is from both.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
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

// How far a figure may be from the reference's.
constexpr double time_tolerance = 0.02;   // [s]
constexpr double state_tolerance = 1e-4;  // [rad], [rad/s]
constexpr double count_tolerance = 0.0;

/// One line of the table.
struct Figure {
  std::string_view name;
  std::string_view unit;
  std::optional<double> paper;  ///< nothing where it does not say
  double reference;
  double ours;
  double tolerance;
  int paper_decimals;  ///< as printed there
  int decimals;

  [[nodiscard]] bool agrees() const { return std::abs(ours - reference) <= tolerance; }
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

std::string fixed(double value, int decimals) {
  return fmt::format("{:.{}f}", value, decimals);
}

/// With its sign, but for a nought.
std::string difference(double value, int decimals) {
  const std::string text = fmt::format("{:+.{}f}", value, decimals);
  return text.find_first_of("123456789") == std::string::npos ? fixed(0.0, decimals) : text;
}

void append_table(std::string& text, std::string_view title, const std::vector<Figure>& figures) {
  constexpr std::string_view row = "  {:30}{:>7}{:>11}{:>11}{:>10}{:>14}{}\n";
  text += fmt::format("{}\n", title);
  text += fmt::format(row, "", "paper", "reference", "ours", "vs paper", "vs reference", "");
  for (const Figure& figure : figures) {
    const auto& paper = figure.paper;
    text += fmt::format(
        row, figure.unit.empty() ? std::string(figure.name) : fmt::format("{} [{}]", figure.name, figure.unit),
        paper ? fixed(*paper, figure.paper_decimals) : "", fixed(figure.reference, figure.decimals),
        fixed(figure.ours, figure.decimals),
        paper ? difference(figure.ours - *paper, std::min(figure.paper_decimals + 1, figure.decimals)) : "",
        difference(figure.ours - figure.reference, figure.decimals), figure.agrees() ? "" : "  OUTSIDE THE TOLERANCE");
  }
}

std::vector<Figure> nominal_figures(const Course& course) {
  const TrialOutcome& end = course.outcome;
  const TrajectorySample& aligned = course.aligned;
  const TrajectorySample& contracting = course.contracting;
  const auto cycles = static_cast<double>(end.cycles);
  return {
      {"T1, end of the alignment", "s", 3.4, 3.40, aligned.t, time_tolerance, 1, 3},
      {"q2_dot there", "rad/s", 0.06, 0.0659, aligned.state.q2_dot, state_tolerance, 2, 5},
      {"end of the transition", "s", 14.9, 14.90, contracting.t, time_tolerance, 1, 3},
      {"q2 there (paper: pi/8)", "rad", std::numbers::pi / 8, 0.3927, contracting.state.q2, state_tolerance, 4, 5},
      {"contraction cycles", "", 9.0, 9.0, cycles, count_tolerance, 0, 0},
      {"duration of those", "s", 32.6, 32.37, end.end_time - contracting.t, time_tolerance, 1, 3},
      {"end", "s", std::nullopt, 47.270, end.end_time, time_tolerance, 0, 3},
      {"q2 there", "rad", std::nullopt, 0.78115, end.end_state.q2, state_tolerance, 0, 5},
      {"q2_dot there", "rad/s", std::nullopt, 5.66e-4, end.end_state.q2_dot, state_tolerance, 0, 6},
  };
}

std::vector<Figure> friction_figures(const Course& course) {
  const TrialOutcome& end = course.outcome;
  const double transition = course.contracting.t;
  const auto cycles = static_cast<double>(end.cycles);
  return {
      {"end of the transition", "s", 18.3, 18.27, transition, time_tolerance, 1, 3},
      {"contraction cycles", "", 7.0, 7.0, cycles, count_tolerance, 0, 0},
      {"duration of those", "s", 49.2, 48.43, end.end_time - transition, time_tolerance, 1, 3},
      {"end", "s", std::nullopt, 66.700, end.end_time, time_tolerance, 0, 3},
      {"q2 there", "rad", std::nullopt, 0.78217, end.end_state.q2, state_tolerance, 0, 5},
      {"q2_dot there", "rad/s", std::nullopt, 7.39e-4, end.end_state.q2_dot, state_tolerance, 0, 6},
  };
}

ExitCode compare_with_the_paper(const std::filesystem::path& specs) {
  const std::vector<Figure> nominal = nominal_figures(course_of(specs / "nominal.json"));
  const std::vector<Figure> friction = friction_figures(course_of(specs / "friction.json"));
  std::string text;
  append_table(text, "Nominal plant, no friction", nominal);
  text += '\n';
  append_table(text, "Friction f1 = f2 = 0.02, realigned after every cycle", friction);
  const auto agrees = [](const Figure& figure) { return figure.agrees(); };
  const bool all =
      std::all_of(nominal.begin(), nominal.end(), agrees) && std::all_of(friction.begin(), friction.end(), agrees);
  text += fmt::format(
      "\nreference: the same trials by an 8th-order integrator at 1e-10. Ours must equal its counts, and be within {} "
      "s of\n"
      "its times and {} of its states.\n",
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
