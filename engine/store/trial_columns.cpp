#include "store/trial_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>

#include "store/column.hpp"
#include "store/layout.hpp"

namespace steerstat::hdf5 {
namespace {

/// Of a settling time, which follows from status and end_time: whether it does.
void check_settling_times(hid_t trials, Rows rows, std::span<const TrialOutcome> outcomes) {
  const auto settling = read_column<double>(trials, "settling_time", "s", rows);
  for (std::size_t row = 0; row < outcomes.size(); ++row) {
    const double expected = outcomes[row].settling_time();
    if (settling[row] != expected && !(std::isnan(settling[row]) && std::isnan(expected))) {
      throw Problem(
          fmt::format("/trials/settling_time in row {} does not follow from status and end_time", rows.begin + row));
    }
    if (outcomes[row].status == Status::converged && !std::isfinite(expected)) {
      throw Problem(fmt::format("/trials/end_time in row {} is not finite, yet the trial converged", rows.begin + row));
    }
  }
}

}  // namespace

void write_outcomes(hid_t trials, std::span<const TrialOutcome> outcomes) {
  const std::size_t rows = outcomes.size();
  write_names(trials, "status", status_names, rows, [&](std::size_t row) { return outcomes[row].status; });
  write_each<double>(trials, "settling_time", rows, "s",
                     [&](std::size_t row) { return outcomes[row].settling_time(); });
  const auto write_field = [&]<class Number>(const layout::OutcomeColumn<Number>& column) {
    write_each<Number>(trials, column.name, rows, column.units, [&](std::size_t row) {
      TrialOutcome outcome = outcomes[row];
      return column.field(outcome);
    });
  };
  for (const auto& column : layout::real_columns) write_field(column);
  for (const auto& column : layout::count_columns) write_field(column);
  for (const auto& column : layout::metric_columns) write_field(column);
}

bool has_every_outcome(hid_t trials) {
  return std::all_of(std::begin(layout::metric_columns), std::end(layout::metric_columns),
                     [&](const auto& column) { return has_member(trials, column.name); });
}

std::vector<TrialOutcome> read_outcomes(hid_t trials, Rows rows) {
  std::vector<TrialOutcome> outcomes(rows.count);
  const std::vector<Status> statuses = read_statuses(trials, "/trials", rows);
  for (std::size_t row = 0; row < rows.count; ++row) outcomes[row].status = statuses[row];
  const auto read_field = [&]<class Number>(const layout::OutcomeColumn<Number>& column) {
    const auto values = read_column<Number>(trials, column.name, column.units, rows);
    for (std::size_t row = 0; row < rows.count; ++row) column.field(outcomes[row]) = values[row];
  };
  for (const auto& column : layout::real_columns) read_field(column);
  for (const auto& column : layout::count_columns) read_field(column);
  for (const auto& column : layout::metric_columns) {
    if (has_member(trials, column.name)) read_field(column);
  }
  check_settling_times(trials, rows, outcomes);
  return outcomes;
}

std::vector<Status> read_statuses(hid_t group, std::string_view place, Rows rows) {
  const Handle type = enumeration(status_names);
  const Column column(group, "status", {type.id(), type.id()}, "1");
  if (column.rows() != rows.of) {
    throw Problem(fmt::format("status has {} rows, {}/index {}", column.rows(), place, rows.of));
  }
  std::vector<std::uint8_t> values(rows.count);
  column.read(rows.begin, rows.count, values.data());
  std::vector<Status> statuses;
  statuses.reserve(rows.count);
  for (std::size_t row = 0; row < rows.count; ++row) {
    if (values[row] >= status_names.size()) {
      throw Problem(fmt::format("{}/status {} in row {} is no outcome", place, values[row], rows.begin + row));
    }
    statuses.push_back(static_cast<Status>(values[row]));
  }
  return statuses;
}

std::vector<std::uint64_t> read_index(hid_t group, std::uint64_t trials) {
  const Column column(group, "index", type_of(std::uint64_t{}), "1");
  if (column.rows() > trials) throw Problem(fmt::format("it has {} rows for {} trials", column.rows(), trials));
  std::vector<std::uint64_t> index(column.rows());
  column.read(index.data());
  if (std::adjacent_find(index.begin(), index.end(), std::greater_equal<>()) != index.end()) {
    throw Problem("/trials/index does not rise");
  }
  if (!index.empty() && index.back() >= trials) {
    throw Problem(fmt::format("/trials/index {} is beyond the last of {} trials", index.back(), trials));
  }
  return index;
}

}  // namespace steerstat::hdf5
