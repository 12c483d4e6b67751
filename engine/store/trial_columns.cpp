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

/// Of settling times, which follow from status and end_time: whether they do. @param begin  row of the first
void check_settling_times(std::size_t begin, std::span<const double> settling, std::span<const TrialOutcome> outcomes) {
  for (std::size_t row = 0; row < outcomes.size(); ++row) {
    const double expected = outcomes[row].settling_time();
    if (settling[row] != expected && !(std::isnan(settling[row]) && std::isnan(expected))) {
      throw Problem(
          fmt::format("/trials/settling_time in row {} does not follow from status and end_time", begin + row));
    }
    if (outcomes[row].status == Status::converged && !std::isfinite(expected)) {
      throw Problem(fmt::format("/trials/end_time in row {} is not finite, yet the trial converged", begin + row));
    }
  }
}

/// Datasets of one type, and the members of an outcome that they fill.
template <class Number>
class OutcomeReader {
 public:
  /// @throws Problem where a dataset is not what it should be
  OutcomeReader(hid_t trials, std::size_t rows) : trials_(trials), rows_(rows) {}

  void open(std::span<const layout::OutcomeColumn<Number>> columns) {
    for (const auto& column : columns) {
      open_.push_back({column_of<Number>(trials_, column.name, column.units, rows_), column.field});
    }
  }

  /// Fills them in outcomes of the rows from `begin` on. @throws Problem
  void read(std::size_t begin, std::span<TrialOutcome> outcomes) {
    values_.resize(outcomes.size());
    for (const auto& [column, field] : open_) {
      column.read(begin, outcomes.size(), values_.data());
      for (std::size_t row = 0; row < outcomes.size(); ++row) field(outcomes[row]) = values_[row];
    }
  }

 private:
  struct Open {
    Column column;
    Number& (*field)(TrialOutcome&);
  };

  hid_t trials_;
  std::size_t rows_;
  std::vector<Open> open_{};
  std::vector<Number> values_{};
};

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
  // So few rows at a time that their outcomes stay in the processor's cache from the first column to the last.
  constexpr std::size_t most_together = 16384;
  std::vector<TrialOutcome> outcomes(rows.count);
  const std::vector<Status> statuses = read_statuses(trials, "/trials", rows);
  OutcomeReader<double> reals(trials, rows.of);
  OutcomeReader<std::uint32_t> counts(trials, rows.of);
  reals.open(layout::real_columns);
  counts.open(layout::count_columns);
  for (const auto& column : layout::metric_columns) {
    if (has_member(trials, column.name)) reals.open({&column, 1});
  }
  const Column settling_times = column_of<double>(trials, "settling_time", "s", rows.of);
  std::vector<double> settling;
  for (std::size_t done = 0; done < rows.count; done += most_together) {
    const std::size_t begin = rows.begin + done;
    const auto together = std::span(outcomes).subspan(done, std::min(most_together, rows.count - done));
    for (std::size_t row = 0; row < together.size(); ++row) together[row].status = statuses[done + row];
    reals.read(begin, together);
    counts.read(begin, together);
    settling.resize(together.size());
    settling_times.read(begin, settling.size(), settling.data());
    check_settling_times(begin, settling, together);
  }
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
