#include "store/sketch_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "store/attribute.hpp"
#include "store/column.hpp"

namespace steerstat::hdf5 {
namespace {

using Cells = std::vector<TrialSketch::Cell>;

constexpr std::size_t chunk_count = Superaccumulator::chunk_count;

/// All rows of a dataset, however many.
template <class Number>
std::vector<Number> read_all(hid_t group, const std::string& name, const std::string& units) {
  const Column column(group, name, type_of(Number{}), units);
  std::vector<Number> values(column.rows());
  column.read(values.data());
  return values;
}

/// @throws Problem unless there are `rows` of them
template <class Number>
std::vector<Number> read_rows(hid_t group, const std::string& name, const std::string& units, std::size_t rows) {
  std::vector<Number> values = read_all<Number>(group, name, units);
  if (values.size() != rows) throw Problem(fmt::format("{} has {} rows (it must be {})", name, values.size(), rows));
  return values;
}

void write_sums(hid_t group, const std::string& name, const Cells& cells, std::size_t metric,
                const Superaccumulator& (Moments::*sum)() const) {
  std::vector<std::int64_t> rows;
  for (const TrialSketch::Cell& cell : cells) {
    const Superaccumulator::Chunks chunks = (cell.metrics[metric].moments.*sum)().chunks();
    rows.insert(rows.end(), chunks.begin(), chunks.end());
  }
  write_column<std::int64_t>(group, name, rows, "1");
}

std::vector<Superaccumulator> read_sums(hid_t group, const std::string& name, std::size_t cells) {
  const auto rows = read_rows<std::int64_t>(group, name, "1", cells * chunk_count);
  std::vector<Superaccumulator> sums;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    Superaccumulator::Chunks chunks{};
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(cell * chunk_count), chunk_count, chunks.begin());
    sums.emplace_back(chunks);
  }
  return sums;
}

void write_buckets(hid_t group, const Cells& cells, std::size_t metric) {
  std::vector<std::uint64_t> cell_of;
  std::vector<std::int32_t> buckets;
  std::vector<std::uint64_t> counts;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    for (const QuantileSketch::Count& count : cells[cell].metrics[metric].quantiles.counts()) {
      cell_of.push_back(cell);
      buckets.push_back(count.bucket);
      counts.push_back(count.count);
    }
  }
  write_column<std::uint64_t>(group, "bucket_cell", cell_of, "1");
  write_column<std::int32_t>(group, "bucket", buckets, "1");
  write_column<std::uint64_t>(group, "bucket_count", counts, "1");
}

void read_buckets(hid_t group, Cells& cells, std::size_t metric) {
  const auto cell_of = read_all<std::uint64_t>(group, "bucket_cell", "1");
  const auto buckets = read_rows<std::int32_t>(group, "bucket", "1", cell_of.size());
  const auto counts = read_rows<std::uint64_t>(group, "bucket_count", "1", cell_of.size());
  std::vector<std::uint64_t> values(cells.size());
  for (std::size_t row = 0; row < cell_of.size(); ++row) {
    if (cell_of[row] >= cells.size() || !QuantileSketch::is_bucket(buckets[row])) {
      throw Problem(fmt::format("row {} of the buckets of {} is of no bucket", row, metrics()[metric].name));
    }
    cells[cell_of[row]].metrics[metric].quantiles.add(QuantileSketch::Count{buckets[row], counts[row]});
    values[cell_of[row]] += counts[row];
  }
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (values[cell] != cells[cell].metrics[metric].moments.count()) {
      throw Problem(fmt::format("the buckets of {} have not as many values as its count", metrics()[metric].name));
    }
  }
}

void write_metric(hid_t parent, const Cells& cells, std::size_t metric) {
  const std::string units(metrics()[metric].unit);
  const Handle group = create_group(parent, std::string(metrics()[metric].name));
  const auto moments = [&](std::size_t cell) -> const Moments& { return cells[cell].metrics[metric].moments; };
  write_each<std::uint64_t>(group.id(), "count", cells.size(), "1", [&](std::size_t i) { return moments(i).count(); });
  write_each<double>(group.id(), "min", cells.size(), units, [&](std::size_t i) { return moments(i).min(); });
  write_each<double>(group.id(), "max", cells.size(), units, [&](std::size_t i) { return moments(i).max(); });
  write_sums(group.id(), "sum", cells, metric, &Moments::sum);
  write_sums(group.id(), "sum_of_squares", cells, metric, &Moments::squares);
  write_buckets(group.id(), cells, metric);
}

void read_metric(hid_t parent, Cells& cells, std::size_t metric) {
  const std::string units(metrics()[metric].unit);
  const Handle group = open_group(parent, std::string(metrics()[metric].name));
  const auto counts = read_rows<std::uint64_t>(group.id(), "count", "1", cells.size());
  const auto least = read_rows<double>(group.id(), "min", units, cells.size());
  const auto most = read_rows<double>(group.id(), "max", units, cells.size());
  const auto sums = read_sums(group.id(), "sum", cells.size());
  const auto squares = read_sums(group.id(), "sum_of_squares", cells.size());
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (counts[cell] > 0 && !(std::isfinite(least[cell]) && least[cell] <= most[cell] && std::isfinite(most[cell]))) {
      throw Problem(fmt::format("{} has no range in cell {}", metrics()[metric].name, cell));
    }
    cells[cell].metrics[metric].moments = Moments::of(counts[cell], least[cell], most[cell], sums[cell], squares[cell]);
  }
  read_buckets(group.id(), cells, metric);
}

}  // namespace

void write_sketch(hid_t file, const TrialSketch& sketch) {
  const Handle group = create_group(file, "sketch");
  const Cells& cells = sketch.cells();
  const std::vector<TrialRange>& trials = sketch.trials();
  write_attribute(group.id(), "relative_error", QuantileSketch::relative_error);
  write_each<std::uint64_t>(group.id(), "begin", trials.size(), "1", [&](std::size_t i) { return trials[i].begin; });
  write_each<std::uint64_t>(group.id(), "end", trials.size(), "1", [&](std::size_t i) { return trials[i].end; });
  for (std::size_t status = 0; status < status_names.size(); ++status) {
    write_each<std::uint64_t>(group.id(), std::string(status_names[status]), cells.size(), "1",
                              [&](std::size_t cell) { return cells[cell].outcomes[status]; });
  }
  write_each<std::uint64_t>(group.id(), "squares", status_names.size(), "1",
                            [&](std::size_t status) { return sketch.squares()[status]; });
  for (std::size_t metric = 0; metric < metric_count; ++metric) write_metric(group.id(), cells, metric);
}

TrialSketch read_sketch(hid_t file, std::uint64_t cells, std::uint64_t trials) {
  const Handle group = open_group(file, "sketch");
  if (read_real_attribute(group.id(), "relative_error") != QuantileSketch::relative_error) {
    throw Problem("its sketch has other buckets than those of this version");
  }
  const auto begins = read_all<std::uint64_t>(group.id(), "begin", "1");
  const auto ends = read_rows<std::uint64_t>(group.id(), "end", "1", begins.size());
  std::vector<TrialRange> ranges;
  for (std::size_t i = 0; i < begins.size(); ++i) {
    if (ends[i] > trials) throw Problem(fmt::format("its sketch goes beyond the last of {} trials", trials));
    ranges.push_back({begins[i], ends[i]});
  }
  Cells of_cells(cells);
  for (std::size_t status = 0; status < status_names.size(); ++status) {
    const auto counts = read_rows<std::uint64_t>(group.id(), std::string(status_names[status]), "1", cells);
    for (std::size_t cell = 0; cell < cells; ++cell) of_cells[cell].outcomes[status] = counts[cell];
  }
  const auto squares = read_rows<std::uint64_t>(group.id(), "squares", "1", status_names.size());
  std::array<std::uint64_t, status_names.size()> of_draws{};
  std::copy(squares.begin(), squares.end(), of_draws.begin());
  for (std::size_t metric = 0; metric < metric_count; ++metric) read_metric(group.id(), of_cells, metric);
  try {
    return TrialSketch::of(std::move(ranges), std::move(of_cells), of_draws);
  } catch (const std::invalid_argument& problem) {
    throw Problem(fmt::format("its sketch is none: {}", problem.what()));
  }
}

}  // namespace steerstat::hdf5
