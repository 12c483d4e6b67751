#include "report/rare_failures_text.hpp"

#include <fmt/color.h>
#include <fmt/format.h>

#include "report/readable.hpp"
#include "report/text_table.hpp"

namespace steerstat {
namespace {

const char* method_name(const RareFailures& rare, bool trusted) {
  if (!trusted) return "Clopper-Pearson, of the nominal draws alone";
  return std::holds_alternative<WeightedFailures>(rare.found) ? "Fay and Feuer" : "lognormal";
}

std::string details(const WeightedFailures& found, bool /*colour*/) {
  return fmt::format(
      "  {} of {} draws failed and count for {:.1f}, the heaviest for {:.2g} % of the estimate; the weights average to "
      "{:.4f}.\n",
      readable_count(found.failures), readable_count(found.draws), found.effective_failures,
      100.0 * found.largest_share, found.mean_weight);
}

std::string details(const SubsetFailures& found, bool colour) {
  TextTable table({{"Level"}, {"Settling from [s]"}, {"Share"}, {"Failed"}, {"Accepted"}, {"Correlation"}});
  for (std::size_t i = 0; i < found.levels.size(); ++i) {
    const SubsetLevel& level = found.levels[i];
    table.add_row({{fmt::format("{}", i)},
                   {level.threshold ? fmt::format("{:.2f}", *level.threshold) : "failure"},
                   {fmt::format("{:.4f}", level.probability)},
                   {readable_count(level.failures)},
                   {level.acceptance ? fmt::format("{:.2f}", *level.acceptance) : "–"},
                   {level.acceptance ? fmt::format("{:.2f}", level.correlation) : "–"}});
  }
  return table.text(colour) + fmt::format("  Coefficient of variation {:.2f}.\n", found.found.variation);
}

}  // namespace

std::string failure_rate_text(const RareFailures& rare) {
  const FailureRate rate = failure_rate(rare);
  return fmt::format("{:.3g}, {} % interval {:.3g} to {:.3g} ({})", rate.estimate, 100.0 * rare.level, rate.low,
                     rate.high, method_name(rare, rate.trusted));
}

std::string rare_failures_text(const RareFailures& rare, bool colour) {
  const FailureRate rate = failure_rate(rare);
  std::string text =
      fmt::format("  {}  {}\n", styled("Failure rate", fmt::emphasis::bold, colour), failure_rate_text(rare));
  if (rate.trusted) {
    text += fmt::format("  As precise as {:.3g} plain trials.\n", equivalent_trials(rare));
  } else {
    text += "  " +
            styled("The estimate is not to be trusted: " + rate.reason + ".",
                   fg(fmt::terminal_color::yellow) | fmt::emphasis::bold, colour) +
            '\n';
  }
  text += '\n' + std::visit([&](const auto& found) { return details(found, colour); }, rare.found);
  if (rate.nominal_interval) {
    text += fmt::format(
        "  Whatever the method misses: {} of the {} plain draws failed, at most {:.3g} (Clopper-Pearson).\n",
        readable_count(rate.nominal.successes), readable_count(rate.nominal.trials), rate.nominal_interval->high);
  }
  return text;
}

}  // namespace steerstat
