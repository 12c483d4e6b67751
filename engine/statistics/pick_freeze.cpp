#include "statistics/pick_freeze.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace steerstat {
namespace {

constexpr std::size_t most_groups = 16'384;

// Sums over rows: of the row itself ...
enum RowSum : std::size_t { rows, a, b, aa, bb, ab, row_sums };
// ... and, for each input, of its variant c = f(AB_i).
enum InputSum : std::size_t { c, cc, ac, bc, input_sums };

void add_row(std::span<const double> row, double mean, std::span<double> sums) {
  const double fa = row[0] - mean;
  const double fb = row[1] - mean;
  sums[rows] += 1.0;
  sums[a] += fa;
  sums[b] += fb;
  sums[aa] += fa * fa;
  sums[bb] += fb * fb;
  sums[ab] += fa * fb;
  for (std::size_t i = 2; i < row.size(); ++i) {
    const double fc = row[i] - mean;
    const std::span<double> input = sums.subspan(row_sums + (i - 2) * input_sums, input_sums);
    input[c] += fc;
    input[cc] += fc * fc;
    input[ac] += fa * fc;
    input[bc] += fb * fc;
  }
}

// Of a pair of columns with a common mean and variance, by their sums.
double pooled_correlation(double n, double x, double y, double xx, double yy, double xy) {
  const double mean = (x + y) / (2.0 * n);
  return (xy / n - mean * mean) / ((xx + yy) / (2.0 * n) - mean * mean);
}

struct Shares {
  double first_order;
  double total;
};

// Not finite where the output does not vary.
Shares shares_of(std::span<const double> sums, std::size_t input) {
  const double n = sums[rows];
  const std::span<const double> s = sums.subspan(row_sums + input * input_sums, input_sums);
  const double mean = (sums[a] + sums[b]) / (2.0 * n);
  const double variance = (sums[aa] + sums[bb]) / (2.0 * n) - mean * mean;
  const double total = std::max(sums[aa] - 2.0 * s[ac] + s[cc], 0.0) / (2.0 * n * variance);
  const double chance = pooled_correlation(n, sums[a], sums[b], sums[aa], sums[bb], sums[ab]);
  const double shared = pooled_correlation(n, sums[b], s[c], sums[bb], s[cc], s[bc]);
  return {shared - std::clamp(1.0 - total, 0.0, 1.0) * chance, total};
}

bool varies(std::span<const double> outputs, std::size_t width) {
  for (std::size_t i = 0; i < outputs.size(); i += width) {
    if (outputs[i] != outputs[0] || outputs[i + 1] != outputs[0]) return true;
  }
  return false;
}

double mean_of_base(std::span<const double> outputs, std::size_t width) {
  double sum = 0.0;
  for (std::size_t i = 0; i < outputs.size(); i += width) sum += outputs[i] + outputs[i + 1];
  const std::size_t rows = outputs.size() / width;
  return sum / (2.0 * static_cast<double>(rows));
}

// (groups x sums): what resamples are made of.
std::vector<double> sums_of_groups(std::span<const double> outputs, std::size_t width, std::size_t sums) {
  const std::size_t row_count = outputs.size() / width;
  const std::size_t rows_a_group = (row_count + most_groups - 1) / most_groups;
  const std::size_t groups = (row_count + rows_a_group - 1) / rows_a_group;
  const double mean = mean_of_base(outputs, width);  // taken off, lest squares of a large mean swamp the variance
  std::vector<double> result(groups * sums, 0.0);
  for (std::size_t row = 0; row < row_count; ++row) {
    add_row(outputs.subspan(row * width, width), mean, std::span(result).subspan(row / rows_a_group * sums, sums));
  }
  return result;
}

void add(std::span<const double> terms, std::span<double> sums) {
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += terms[i];
}

}  // namespace

std::optional<std::vector<SobolIndices>> pick_freeze_indices(std::span<const double> outputs, std::size_t inputs,
                                                             const Resampling& resampling) {
  const std::size_t width = inputs + 2;
  if (inputs == 0 || outputs.size() % width != 0) {
    throw std::invalid_argument("pick_freeze_indices: needs whole rows of inputs + 2 outputs, inputs > 0");
  }
  if (outputs.size() / width < least_sensitivity_sample || !varies(outputs, width)) return std::nullopt;
  const std::size_t sums = row_sums + inputs * input_sums;
  const std::vector<double> groups = sums_of_groups(outputs, width, sums);
  std::vector<double> all(sums, 0.0);
  std::vector<double> resampled(resample_count * sums, 0.0);
  for (std::size_t group = 0; group * sums < groups.size(); ++group) {
    const std::span<const double> terms = std::span(groups).subspan(group * sums, sums);
    add(terms, all);
    for (std::size_t k = 0; k < resample_count; ++k) {
      const std::uint64_t word = resampling_word(resampling.seed, group, k / resamples_a_batch);
      if ((word >> (k % resamples_a_batch) & 1U) != 0) add(terms, std::span(resampled).subspan(k * sums, sums));
    }
  }
  std::vector<SobolIndices> indices;
  std::vector<double> first_order(resample_count);
  std::vector<double> total(resample_count);
  for (std::size_t input = 0; input < inputs; ++input) {
    for (std::size_t k = 0; k < resample_count; ++k) {
      const Shares shares = shares_of(std::span(resampled).subspan(k * sums, sums), input);
      const bool given = std::isfinite(shares.first_order) && std::isfinite(shares.total);
      first_order[k] = given ? shares.first_order : std::numeric_limits<double>::quiet_NaN();
      total[k] = given ? shares.total : std::numeric_limits<double>::quiet_NaN();
    }
    const Shares shares = shares_of(all, input);
    const auto first = bootstrap_interval(shares.first_order, first_order, resampling.level);
    const auto whole = bootstrap_interval(shares.total, total, resampling.level);
    if (!first || !whole) return std::nullopt;
    indices.push_back({*first, *whole});
  }
  return indices;
}

}  // namespace steerstat
