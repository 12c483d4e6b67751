#include "view/axis.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "study/inputs.hpp"

namespace steerstat {
namespace {

bool is_discrete(const Input& input, bool listed) {
  if (listed || std::holds_alternative<Sweep>(input.value)) return true;
  const auto* distribution = std::get_if<Distribution>(&input.value);
  return distribution != nullptr && std::holds_alternative<Discrete>(distribution->shape);
}

bool is_bounded(const Input& input, bool listed) {
  const auto* distribution = std::get_if<Distribution>(&input.value);
  if (listed || distribution == nullptr) return true;
  const Support support = distribution->support();
  return std::isfinite(support.low) && std::isfinite(support.high);
}

// The different values, rising; nothing where they are more than `most`.
std::optional<std::vector<double>> levels_of(std::span<const double> values, std::size_t most) {
  std::set<double> levels;
  for (const double value : values) {
    levels.insert(value);
    if (levels.size() > most) return std::nullopt;
  }
  return std::vector<double>(levels.begin(), levels.end());
}

struct Span {
  double low;
  double high;
};

Span span_of(const Input& input, bool listed, std::span<const double> values) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  if (is_bounded(input, listed)) return {*least, *greatest};
  constexpr double tail = 0.001;
  std::vector<double> sorted(values.begin(), values.end());
  const auto rank = static_cast<std::ptrdiff_t>(tail * static_cast<double>(sorted.size() - 1));
  const auto low = sorted.begin() + rank;
  std::nth_element(sorted.begin(), low, sorted.end());
  const auto high = sorted.end() - 1 - rank;
  if (high > low) std::nth_element(low + 1, high, sorted.end());
  return {*low, *high};
}

}  // namespace

std::optional<std::size_t> Axis::bin_of(double value) const {
  if (!levels.empty()) {
    const auto found = std::lower_bound(levels.begin(), levels.end(), value);
    if (found == levels.end() || *found != value) return std::nullopt;
    return static_cast<std::size_t>(found - levels.begin());
  }
  if (!(value >= edges.front() && value <= edges.back())) return std::nullopt;
  const std::size_t last = edges.size() - 2;
  const double share = (value - edges.front()) / (edges.back() - edges.front());
  std::size_t k = std::min(static_cast<std::size_t>(share * static_cast<double>(last + 1)), last);
  while (k > 0 && value < edges[k]) --k;  // what rounding may have done
  while (k < last && value >= edges[k + 1]) ++k;
  return k;
}

Axis axis_of(const Input& input, bool listed, std::span<const double> values, std::size_t bins) {
  Axis axis{input.name, std::string(find_input(input.name)->unit), {}, {}};
  if (is_discrete(input, listed)) {
    if (auto levels = levels_of(values, most_levels)) {
      axis.levels = std::move(*levels);
      return axis;
    }
  }
  const auto [low, high] = span_of(input, listed, values);
  if (!(high > low)) {  // one trial, or all alike
    axis.levels = {low};
    return axis;
  }
  const auto n = static_cast<double>(bins);
  for (std::size_t k = 0; k < bins; ++k) axis.edges.push_back(low + (high - low) * static_cast<double>(k) / n);
  axis.edges.push_back(high);
  return axis;
}

std::vector<std::uint16_t> bin_numbers(const Axis& axis, std::span<const double> values) {
  std::vector<std::uint16_t> bins;
  bins.reserve(values.size());
  for (const double value : values) {
    const std::optional<std::size_t> bin = axis.bin_of(value);
    bins.push_back(bin ? static_cast<std::uint16_t>(*bin) : outside_axis);
  }
  return bins;
}

BinCounts count_bins(std::size_t bins, std::span<const std::uint16_t> bin, std::span<const std::uint8_t> converged) {
  BinCounts counts{std::vector<std::uint64_t>(bins), std::vector<std::uint64_t>(bins)};
  for (std::size_t i = 0; i < bin.size(); ++i) {
    if (bin[i] == outside_axis) {
      ++counts.outside;
      continue;
    }
    ++counts.trials[bin[i]];
    counts.successes[bin[i]] += converged[i];
  }
  return counts;
}

BinCounts count_bins(std::size_t x_bins, std::span<const std::uint16_t> x, std::size_t y_bins,
                     std::span<const std::uint16_t> y, std::span<const std::uint8_t> converged) {
  BinCounts counts{std::vector<std::uint64_t>(x_bins * y_bins), std::vector<std::uint64_t>(x_bins * y_bins)};
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] == outside_axis || y[i] == outside_axis) {
      ++counts.outside;
      continue;
    }
    const std::size_t at = std::size_t{y[i]} * x_bins + x[i];
    ++counts.trials[at];
    counts.successes[at] += converged[i];
  }
  return counts;
}

}  // namespace steerstat
