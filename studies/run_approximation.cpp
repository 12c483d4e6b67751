#include "run_approximation.hpp"

#include <fmt/format.h>

#include "output.hpp"
#include "report/approximation_summary.hpp"
#include "store/result_file.hpp"

namespace steerstat {

ExitCode run_approximation_study(const ApproximationStudy& study, const std::optional<std::string>& summary) {
  const bool to_file = summary && *summary != "-";
  if (to_file) require_writable(*summary);
  const ApproximationSummary found = summarise(study, run_approximation(study));
  if (to_file) {
    write_text(*summary, approximation_json(found));
    tell(fmt::format("wrote the summary to {}", *summary));
  }
  print(summary == "-" ? approximation_json(found) : approximation_text(found, wants_colour(StandardStream::output)));
  return ExitCode::done;
}

}  // namespace steerstat
