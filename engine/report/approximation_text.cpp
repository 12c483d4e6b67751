#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>

#include "report/approximation_summary.hpp"
#include "report/readable.hpp"
#include "report/text_table.hpp"

namespace steerstat {
namespace {

using Align = TextTable::Align;
using Cell = ApproximationSummary::Cell;

constexpr std::size_t most_approximated_cells = 60;

/// What the columns of the tables of cells are.
struct Shown {
  const char* measure;
  const char* title;
  double scale;
};
constexpr std::array<Shown, 5> shown_errors{{{"position_step", "Error of the position's step (12), in % of it", 100.0},
                                             {"velocity_step", "Error of the velocity's step (13), in % of it", 100.0},
                                             {"velocity_end", "Error of q2_dot at the end [rad/s]", 1.0},
                                             {"position_end", "Error of q2 at the end [rad]", 1.0},
                                             {"position_worst", "Largest error of q2 within the cycle [rad]", 1.0}}};

std::size_t index_of(std::string_view name) {
  const auto measures = error_measures();
  const auto found = std::find_if(measures.begin(), measures.end(), [&](const auto& m) { return m.name == name; });
  return static_cast<std::size_t>(found - measures.begin());
}

std::string error_text(double x) {
  if (x >= 1e-2 && x < 1e5) return fmt::format("{:.3g}", x);
  return fmt::format("{:.1e}", x);
}

std::string quantiles(const SampleStatistics& error, double scale) {
  return fmt::format("{} {} {}", error_text(scale * error.p50), error_text(scale * error.p95),
                     error_text(scale * error.max));
}

/// A table of one measure, a row a cell: what is swept, then the median, the 95 % quantile and the largest error.
std::string measure_text(const std::vector<Cell>& cells, const Shown& what, bool colour) {
  std::vector<TextTable::Column> columns;
  for (std::size_t i = 0; i < cells.front().sweep.size(); ++i) {
    if (cells.front().sweep[i]) columns.push_back({std::string(cycle_definitions()[i].name)});
  }
  columns.insert(columns.end(), {{"median"}, {"95 %"}, {"99 %"}, {"max"}});
  TextTable table(columns);
  for (std::size_t row = 0; row < std::min(cells.size(), most_approximated_cells); ++row) {
    std::vector<TextTable::Cell> line;
    for (const std::optional<double>& value : cells[row].sweep) {
      if (value) line.push_back({fmt::format("{:.6g}", *value)});
    }
    const SampleStatistics& error = cells[row].errors[index_of(what.measure)];
    for (const double value : {error.p50, error.p95, error.p99, error.max}) {
      line.push_back({error_text(what.scale * value)});
    }
    table.add_row(std::move(line));
  }
  return fmt::format("  {}\n{}", styled(what.title, bold, colour), table.text(colour));
}

/// The distinct values of a swept input, in the cells' order.
std::vector<double> levels(const std::vector<Cell>& cells, CycleInput input) {
  std::vector<double> values;
  for (const Cell& cell : cells) {
    const double value = *cell.sweep[static_cast<std::size_t>(input)];
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

bool sweeps_amplitude_and_period_alone(const Cell& cell) {
  return !cell.sweep[0] && !cell.sweep[1] && cell.sweep[2] && cell.sweep[3];
}

/// The same as a square: a row an amplitude, a column a period.
std::string square_text(const std::vector<Cell>& cells, const Shown& what, bool colour) {
  const std::vector<double> amplitudes = levels(cells, CycleInput::amplitude);
  const std::vector<double> periods = levels(cells, CycleInput::period);
  std::vector<TextTable::Column> columns{{"A [m]"}};
  for (const double period : periods) columns.push_back({fmt::format("T = {:.4g} s", period)});
  TextTable table(columns);
  for (std::size_t row = 0; row < amplitudes.size(); ++row) {
    std::vector<TextTable::Cell> line{{fmt::format("{:.4g}", amplitudes[row]), bold}};
    for (std::size_t column = 0; column < periods.size(); ++column) {
      // The period is the last factor, which changes fastest.
      line.push_back({quantiles(cells[row * periods.size() + column].errors[index_of(what.measure)], what.scale)});
    }
    table.add_row(std::move(line));
  }
  return fmt::format("  {}: median, 95 % and largest\n{}", styled(what.title, bold, colour), table.text(colour));
}

std::string order_text(const std::optional<FittedOrder>& order) {
  if (!order) return "–";
  if (!order->standard_error) return fmt::format("{:.2f}", order->mean);
  return fmt::format("{:.2f} ± {:.2f}", order->mean, *order->standard_error);
}

std::string orders_text(const ApproximationSummary& summary, bool colour) {
  TextTable table({{"Fitted order", Align::left}, {"in A"}, {"in T"}, {"in T, A ~ T^2"}});
  for (std::size_t m = 0; m < error_measure_count; ++m) {
    const ApproximationSummary::Orders& orders = summary.orders[m];
    table.add_row({{std::string(error_measures()[m].name)},
                   {order_text(orders.amplitude)},
                   {order_text(orders.period)},
                   {order_text(orders.dilation)}});
  }
  return table.text(colour) + styled("  Mean over the draws ± its standard error.\n", faint, colour);
}

}  // namespace

std::string approximation_text(const ApproximationSummary& summary, bool colour) {
  const std::size_t cells = summary.cells.size();
  std::string text = styled(printable(summary.name), bold, colour) + '\n' +
                     styled(fmt::format("error of the nilpotent approximation in {} ({} in {}) · "
                                        "seed {} · K {:.4g} /m · engine {}\n",
                                        counted(cells * summary.draws, "cycle"), counted(summary.draws, "draw"),
                                        counted(cells, "cell"), summary.seed, summary.coupling, summary.engine_version),
                            faint, colour);
  for (const Shown& what : shown_errors) {
    text += '\n';
    text += sweeps_amplitude_and_period_alone(summary.cells.front()) ? square_text(summary.cells, what, colour)
                                                                     : measure_text(summary.cells, what, colour);
  }
  const ApproximationSummary::Orders& orders = summary.orders.front();
  if (orders.amplitude || orders.period) text += '\n' + orders_text(summary, colour);
  if (cells > most_approximated_cells && !sweeps_amplitude_and_period_alone(summary.cells.front())) {
    text += styled(fmt::format("  The first {} cells; the JSON summary has them all.\n", most_approximated_cells),
                   faint, colour);
  }
  return text;
}

}  // namespace steerstat
