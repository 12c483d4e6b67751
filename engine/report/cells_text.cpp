#include "report/cells_text.hpp"

#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "report/readable.hpp"
#include "report/text_table.hpp"

namespace steerstat {
namespace {

using Align = TextTable::Align;

constexpr std::size_t most_cells = 30;  // more are shortened to the best and the worst
constexpr std::size_t best_cells = 15;
constexpr std::size_t worst_cells = 5;

/// The last `parts` dotted parts of a name.
std::string suffix(const std::string& name, std::size_t parts) {
  std::size_t begin = name.size() + 1;
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t dot = begin < 2 ? std::string::npos : name.rfind('.', begin - 2);
    if (dot == std::string::npos) return name;
    begin = dot + 1;
  }
  return name.substr(begin);
}

/// The swept inputs' names, without the leading parts that are not needed to tell them apart.
std::vector<std::string> short_names(const std::vector<Plan::SweptValue>& sweep) {
  constexpr std::size_t most_parts = 4;
  std::vector<std::string> names;
  for (std::size_t parts = 1; parts <= most_parts; ++parts) {
    names.clear();
    for (const Plan::SweptValue& swept : sweep) names.push_back(suffix(swept.name, parts));
    if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) break;
  }
  return names;
}

std::string failure_causes(const TrialStatistics& cell) {
  std::string text;
  for (std::size_t i = 0; i < status_names.size(); ++i) {
    if (static_cast<Status>(i) == Status::converged || cell.outcomes[i] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", readable_count(cell.outcomes[i]), status_names[i]);
  }
  return text;
}

std::vector<TextTable::Cell> cell_row(const Summary::Cell& cell) {
  const TrialStatistics& statistics = cell.statistics;
  std::vector<TextTable::Cell> row;
  for (const Plan::SweptValue& swept : cell.sweep) row.push_back({fmt::format("{:.6g}", swept.value)});
  const auto& rate = statistics.success_rate;
  row.push_back({rate ? readable_share(rate->estimate, statistics.completed) : no_data, bold});
  row.push_back({rate ? readable_shares(rate->low, rate->high, statistics.completed) : no_data});
  const auto quantile = [](const std::optional<SampleStatistics>& sample, double SampleStatistics::*member,
                           int decimals) {
    return TextTable::Cell{sample ? fmt::format("{:.{}f}", (*sample).*member, decimals) : no_data};
  };
  row.push_back(quantile(statistics.of("settling_time"), &SampleStatistics::p50, 2));
  row.push_back(quantile(statistics.of("settling_time"), &SampleStatistics::p95, 2));
  row.push_back(quantile(statistics.of("cycles"), &SampleStatistics::p50, 1));
  row.push_back({failure_causes(statistics), faint});
  return row;
}

/// The cells' numbers by falling success rate, then rising median settling time, then number.
std::vector<std::size_t> ranking(const std::vector<Summary::Cell>& cells) {
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const TrialStatistics& statistics = cells[i].statistics;
    const auto& settling_time = statistics.of("settling_time");
    return std::pair(statistics.success_rate ? -statistics.success_rate->estimate : 1.0,
                     settling_time ? settling_time->p50 : 0.0);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

}  // namespace

std::string cells_text(const std::vector<Summary::Cell>& cells, double level, bool colour) {
  std::vector<TextTable::Column> columns;
  for (std::string& name : short_names(cells.front().sweep)) columns.push_back({std::move(name)});
  columns.insert(columns.end(), {{"Success"},
                                 {fmt::format("{} % interval", 100.0 * level)},
                                 {"Median [s]"},
                                 {"95 % [s]"},
                                 {"Cycles"},
                                 {"Failures", Align::left}});
  TextTable table(columns);
  if (cells.size() <= most_cells) {
    for (const Summary::Cell& cell : cells) table.add_row(cell_row(cell));
    return table.text(colour);
  }
  const std::vector<std::size_t> order = ranking(cells);
  for (std::size_t i = 0; i < best_cells; ++i) table.add_row(cell_row(cells[order[i]]));
  table.add_row(std::vector<TextTable::Cell>(columns.size(), {"⋮", faint}));
  for (std::size_t i = order.size() - worst_cells; i < order.size(); ++i) table.add_row(cell_row(cells[order[i]]));
  return table.text(colour) +
         styled(fmt::format("  The {} best and {} worst of {} cells by success rate; the JSON summary has them all.\n",
                            best_cells, worst_cells, readable_count(cells.size())),
                faint, colour);
}

}  // namespace steerstat
