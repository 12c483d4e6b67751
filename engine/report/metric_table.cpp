#include "report/metric_table.hpp"

#include <fmt/color.h>
#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <vector>

#include "report/text_table.hpp"

namespace steerstat {
namespace {

struct Row {
  const char* label;
  std::string_view metric;
  const char* format;  // of its numbers
};

std::string table_of(const char* title, const std::vector<Row>& rows, const TrialStatistics& statistics, bool colour) {
  TextTable table(
      {{title, TextTable::Align::left}, {"min"}, {"5 %"}, {"median"}, {"95 %"}, {"99 %"}, {"max"}, {"mean"}, {"std"}});
  bool empty = true;
  for (const Row& row : rows) {
    const std::optional<SampleStatistics>& sample = statistics.of(row.metric);
    if (!sample) continue;
    empty = false;
    std::vector<TextTable::Cell> cells{{row.label}};
    for (const double value :
         {sample->min, sample->p05, sample->p50, sample->p95, sample->p99, sample->max, sample->mean}) {
      cells.push_back({fmt::format(fmt::runtime(row.format), value)});
    }
    cells.push_back({sample->std ? fmt::format(fmt::runtime(row.format), *sample->std) : "–"});
    cells[3].style = fmt::emphasis::bold;
    table.add_row(std::move(cells));
  }
  return empty ? "" : table.text(colour);
}

}  // namespace

std::string metric_tables(const TrialStatistics& statistics, bool colour) {
  std::string text =
      table_of("Converged trials", {{"settling time [s]", "settling_time", "{:.2f}"}, {"cycles", "cycles", "{:.1f}"}},
               statistics, colour);
  const std::string all = table_of("All trials",
                                   {{"effort [N² s]", "effort", "{:.4g}"},
                                    {"peak |a| [m/s²]", "peak_acceleration", "{:.4g}"},
                                    {"peak |tau| [N]", "peak_force", "{:.4g}"},
                                    {"peak |q1 - goal| [m]", "peak_stroke", "{:.4g}"}},
                                   statistics, colour);
  const std::string contraction = table_of("Contraction ratios",
                                           {{"position, mean", "position_contraction_mean", "{:.4f}"},
                                            {"position, worst", "position_contraction_worst", "{:.4f}"},
                                            {"velocity, mean", "velocity_contraction_mean", "{:.4f}"},
                                            {"velocity, worst", "velocity_contraction_worst", "{:.4f}"}},
                                           statistics, colour);
  for (const std::string& table : {all, contraction}) {
    if (!text.empty() && !table.empty()) text += '\n';
    text += table;
  }
  return text;
}

}  // namespace steerstat
