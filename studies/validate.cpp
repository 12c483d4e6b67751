#include <fmt/format.h>

#include <memory>
#include <variant>

#include "commands.hpp"
#include "output.hpp"
#include "report/readable.hpp"
#include "spec_file.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

constexpr const char* validate_epilogue = R"(Examples:
  steerstat validate study.json
  make-study | steerstat validate -

Exits 0 when the spec is valid, 2 with every mistake on standard error when it is not.)";

std::string describe(const Study& study) {
  const Plan plan(study);
  std::string text = fmt::format("{}: a valid study\n", printable(study.name));
  text += fmt::format("  id          {}\n", study_id(study));
  text += fmt::format("  trials      {}", readable_count(plan.trials()));
  if (plan.cells() > 1)
    text += fmt::format(" ({} of {})", counted(plan.cells(), "cell"), readable_count(plan.trials() / plan.cells()));
  text += fmt::format("\n  sampling    {}", sampling_method_names[static_cast<std::size_t>(study.sampling.method)]);
  if (draws(study.sampling.method)) text += fmt::format(", seed {}", study.sampling.seed);
  text += fmt::format("\n  varying     {}\n",
                      plan.varying().empty() ? "nothing" : fmt::format("{}", fmt::join(plan.varying(), ", ")));
  text += fmt::format("  integrator  {}, tolerance {}\n",
                      IntegratorChoice::method_names[static_cast<std::size_t>(study.integrator.method)],
                      study.integrator.tolerance);
  return text;
}

std::string describe(const ApproximationStudy& study) {
  const CyclePlan plan(study);
  return fmt::format("{}: a valid approximation study\n  cycles      {} ({} of {})\n  sampling    seed {}\n",
                     printable(study.name), readable_count(plan.cells() * plan.draws()), counted(plan.cells(), "cell"),
                     readable_count(plan.draws()), study.seed);
}

}  // namespace

void add_validate(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("validate", "Check a study spec without running it");
  const auto spec = std::make_shared<std::string>();
  command->add_option("SPEC", *spec, "The study's JSON file; - reads standard input")->required()->option_text(" ");
  command->footer(validate_epilogue);
  command->callback([spec, &exit_code] {
    const std::variant<Study, ApproximationStudy> study = read_any_study(*spec);
    print(std::visit([](const auto& of_its_kind) { return describe(of_its_kind); }, study));
    exit_code = ExitCode::done;
  });
}

}  // namespace steerstat
