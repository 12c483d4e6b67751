#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "report/readable.hpp"
#include "report/sensitivity.hpp"
#include "report/text_table.hpp"

namespace steerstat {
namespace {

using Align = TextTable::Align;

constexpr int index_bar_width = 24;

std::string share_text(double share) {
  const std::string text = fmt::format("{:.3f}", share);
  return text == "-0.000" ? "0.000" : text;
}

std::string interval_text(const SensitivityIndex& index) {
  return fmt::format("{} to {}", share_text(index.low), share_text(index.high));
}

std::string bar(double low, double high) {
  const double from = std::clamp(low, 0.0, 1.0);
  return interval_bar(from, std::clamp(high, from, 1.0), index_bar_width);
}

/// Positions by falling key; equal ones stay in their order.
std::vector<std::size_t> ranking(std::size_t count, const std::function<double(std::size_t)>& key) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) > key(b); });
  return order;
}

std::string level_text(double level) {
  return fmt::format("{:.6g} % interval", 100.0 * level);
}

std::string no_indices(const std::string& name, std::uint64_t count, const char* what, bool colour) {
  return fmt::format("  {}  no indices: {} {} (at least {}), or no variation\n", styled(name, bold, colour),
                     readable_count(count), what, least_sensitivity_sample);
}

std::string given_data_output_text(const GivenDataSensitivity& given, const GivenDataSensitivity::Output& output,
                                   bool colour) {
  const auto has = [](const std::optional<SensitivityIndex>& index) { return index.has_value(); };
  if (std::none_of(output.indices.begin(), output.indices.end(), has)) {
    return no_indices(output.name, output.trials, "trials", colour);
  }
  TextTable table(
      {{output.name, Align::left}, {"First order"}, {given.exact ? "" : level_text(given.level)}, {"", Align::left}});
  const auto key = [&](std::size_t i) { return output.indices[i] ? output.indices[i]->estimate : -1e300; };
  for (const std::size_t i : ranking(given.inputs.size(), key)) {
    if (!output.indices[i]) {
      table.add_row({{given.inputs[i], faint}, {"–", faint}, {""}, {""}});
      continue;
    }
    const SensitivityIndex& index = *output.indices[i];
    const fmt::text_style style = index.low > 0.0 ? fmt::text_style{} : faint;
    table.add_row({{given.inputs[i], style},
                   {share_text(index.estimate), style},
                   {given.exact ? "" : interval_text(index), style},
                   {bar(index.low, index.high), style}});
  }
  return table.text(colour) + styled(fmt::format("  of {}\n", counted(output.trials, "trial")), faint, colour);
}

std::string sobol_output_text(const SobolSensitivity& sobol, const SobolSensitivity::Output& output, bool colour) {
  if (!output.indices) return no_indices(output.name, output.rows, "whole rows", colour);
  const std::vector<SobolIndices>& indices = *output.indices;
  TextTable table({{output.name, Align::left},
                   {"First order"},
                   {level_text(sobol.level)},
                   {"Total"},
                   {level_text(sobol.level)},
                   {"alone █ with others ▒", Align::left}});
  for (const std::size_t i : ranking(indices.size(), [&](std::size_t k) { return indices[k].total.estimate; })) {
    const fmt::text_style style = indices[i].total.low > 0.0 ? fmt::text_style{} : faint;
    table.add_row({{sobol.inputs[i], style},
                   {share_text(indices[i].first_order.estimate), style},
                   {interval_text(indices[i].first_order), style},
                   {share_text(indices[i].total.estimate), style},
                   {interval_text(indices[i].total), style},
                   {bar(indices[i].first_order.estimate, indices[i].total.estimate), style}});
  }
  const std::uint64_t rows = sobol.independent_trials / 2;
  const std::string which =
      output.rows < rows ? fmt::format(" of {}: those with it in every trial", readable_count(rows)) : "";
  return table.text(colour) + styled(fmt::format("  of {}{}\n", counted(output.rows, "row"), which), faint, colour);
}

}  // namespace

std::string sobol_text(const SobolSensitivity& sobol, bool colour) {
  std::string text =
      "  " + styled("Sobol' indices", bold, colour) + "  shares of the variance, by the pick-freeze design\n";
  for (const SobolSensitivity::Output& output : sobol.outputs) text += '\n' + sobol_output_text(sobol, output, colour);
  return text;
}

std::string sensitivity_text(const SensitivityReport& report, bool colour) {
  std::string text = styled(printable(report.name), bold, colour) + '\n';
  text += styled(fmt::format("id {}{}", report.id, report.complete ? "" : " · incomplete"), faint, colour) + "\n\n";
  if (report.sobol) text += sobol_text(*report.sobol, colour) + '\n';
  if (report.given_data.inputs.empty()) return text + "  Nothing varies in this study.\n";
  text += fmt::format("  {}  shares of the variance that an input explains alone, {}\n",
                      styled("First-order indices", bold, colour),
                      report.given_data.exact ? "exact for the grid" : "from the trials as they are");
  for (const GivenDataSensitivity::Output& output : report.given_data.outputs) {
    text += '\n' + given_data_output_text(report.given_data, output, colour);
  }
  return text;
}

}  // namespace steerstat
