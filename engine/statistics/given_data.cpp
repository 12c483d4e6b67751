#include "statistics/given_data.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "statistics/resampled_sums.hpp"
#include "statistics/sensitivity_bins.hpp"

namespace steerstat {
namespace {

UnitSums sums_of(std::span<const BinEntry> units) {
  UnitSums sums;
  for (const BinEntry& unit : units) sums.add(unit);
  return sums;
}

double variance_of(const UnitSums& sums) {
  return sums.squares / sums.count - sums.mean_over_pairs();
}

// E[E[y | x]^2]: the bins' means over pairs, weighted by their trials. Bins without pairs have no say.
struct MeanOverBins {
  double weighted{0.0};
  double weight{0.0};

  void add(const UnitSums& bin) {
    if (!(bin.pairs() > 0.0)) return;
    weighted += bin.count * bin.mean_over_pairs();
    weight += bin.count;
  }
  [[nodiscard]] double value() const { return weighted / weight; }
};

// Variance that a bin's mean over pairs has where y's mean is the same whatever x.
double degenerate_variance(std::span<const BinEntry> bin, const UnitSums& sums) {
  if (!(sums.pairs() > 0.0)) return 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  for (const BinEntry& entry : bin) {
    const double residual = entry.sum - sums.sum / sums.count * entry.count;
    squares += residual * residual;
    fourths += residual * residual * residual * residual;
  }
  // Residuals about the bin's own mean are too small by 1 - 1/n in square.
  const double n = static_cast<double>(bin.size());
  const double unbiased = std::max(squares * squares - fourths, 0.0) * (n / (n - 1.0)) * (n / (n - 1.0));
  return 2.0 * unbiased / (sums.pairs() * sums.pairs());
}

}  // namespace

GivenData::GivenData(std::span<const double> y, std::span<const std::uint64_t> unit, const Resampling& resampling)
    : y_(y.begin(), y.end()), unit_(unit.begin(), unit.end()), resampling_(resampling) {
  if (y.size() != unit.size()) throw std::invalid_argument("GivenData: needs columns of one length");
  varies_ = std::adjacent_find(y.begin(), y.end(), std::not_equal_to<>()) != y.end();
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
  for (double& value : y_) value -= mean;  // lest the square of a large mean swamp the variance
  const std::vector<BinEntry> units = sorted_entries(std::vector<double>(y.size(), 0.0), y_, unit);
  units_ = units.size();
  const UnitSums all = sums_of(units);
  squared_mean_ = all.mean_over_pairs();
  variance_ = variance_of(all);
  const ResampledSums resampled = resampled_sums(units, resampling.seed);
  for (std::size_t k = 0; k < resample_count; ++k) {
    resampled_squared_mean_[k] = resampled[k].mean_over_pairs();
    resampled_variance_[k] = variance_of(resampled[k]);
  }
}

std::optional<SensitivityIndex> GivenData::first_order(std::span<const double> x) const {
  if (x.size() != y_.size()) throw std::invalid_argument("GivenData: needs columns of one length");
  if (!varies_ || units_ < least_sensitivity_sample) return std::nullopt;
  const std::vector<BinEntry> entries = sorted_entries(x, y_, unit_);
  const bool one_entry_a_unit = entries.size() == units_;
  MeanOverBins mean;
  std::array<MeanOverBins, resample_count> resampled_mean;
  double degenerate = 0.0;
  std::vector<BinEntry> bin;
  std::size_t begin = 0;
  for (const std::size_t end : bin_ends(entries)) {
    bin.assign(entries.begin() + static_cast<std::ptrdiff_t>(begin),
               entries.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end;
    if (!one_entry_a_unit) merge_units(bin);
    const UnitSums sums = sums_of(bin);
    mean.add(sums);
    // A unit that is in several bins has dependent parts; their variance is then left as the resamples show it.
    if (one_entry_a_unit) degenerate += sums.count * sums.count * degenerate_variance(bin, sums);
    const ResampledSums resampled_bin = resampled_sums(bin, resampling_.seed);
    for (std::size_t k = 0; k < resample_count; ++k) resampled_mean[k].add(resampled_bin[k]);
  }
  std::array<double, resample_count> resampled{};
  for (std::size_t i = 0; i < resample_count; ++i) {
    const double variance = resampled_variance_[i];
    resampled[i] = variance > 0.0 ? (resampled_mean[i].value() - resampled_squared_mean_[i]) / variance
                                  : std::numeric_limits<double>::quiet_NaN();
  }
  const double share = (mean.value() - squared_mean_) / variance_;
  return bootstrap_interval(share, resampled, resampling_.level,
                            degenerate / (mean.weight * mean.weight * variance_ * variance_));
}

std::optional<SensitivityIndex> factorial_index(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) throw std::invalid_argument("factorial_index: needs columns of one length");
  if (std::adjacent_find(y.begin(), y.end(), std::not_equal_to<>()) == y.end()) return std::nullopt;
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
  std::vector<BinEntry> values =
      sorted_entries(x, y, std::vector<std::uint64_t>(y.size(), 0));  // one unit: an entry a value of x
  double between = 0.0;
  for (const BinEntry& value : values) {
    between += value.count * (value.sum / value.count - mean) * (value.sum / value.count - mean);
  }
  double all = 0.0;
  for (const double value : y) all += (value - mean) * (value - mean);
  const double share = between / all;
  return SensitivityIndex{share, share, share};
}

}  // namespace steerstat
