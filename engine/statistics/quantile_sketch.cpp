#include "statistics/quantile_sketch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace steerstat {
namespace {

constexpr unsigned dropped_digits = 42;                       // of 52, so that 10 tell the bucket
constexpr std::int32_t first_normal = std::int32_t{1} << 10;  // the least bucket of a double that is not subnormal
constexpr std::int32_t infinite = std::int32_t{0x7FF} << 10;

/// The lower end of a bucket of positive values.
double lower_end(std::int32_t bucket) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(bucket) << dropped_digits);
}

}  // namespace

std::int32_t QuantileSketch::bucket_of(double value) {
  const auto size = static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(std::abs(value)) >> dropped_digits);
  if (size < first_normal) return 0;
  return value < 0.0 ? -size : size;
}

bool QuantileSketch::is_bucket(std::int32_t bucket) {
  const std::int32_t size = std::abs(std::max(bucket, -infinite));
  return bucket == 0 || (size >= first_normal && size < infinite);
}

QuantileSketch::Bucket QuantileSketch::bounds_of(std::int32_t bucket) {
  if (bucket == 0) return {0.0, 0.0};
  if (bucket > 0) return {lower_end(bucket), lower_end(bucket + 1)};
  return {-lower_end(-bucket + 1), -lower_end(-bucket)};
}

void QuantileSketch::add(const QuantileSketch& other) {
  for (const auto& [number, page] : other.pages_) {
    Page& sum = pages_[number];
    for (std::size_t i = 0; i < page.size(); ++i) sum[i] += page[i];
  }
}

std::vector<QuantileSketch::Count> QuantileSketch::counts() const {
  std::vector<std::int32_t> numbers;
  for (const auto& [number, page] : pages_) numbers.push_back(number);
  std::sort(numbers.begin(), numbers.end());
  std::vector<Count> counts;
  for (const std::int32_t number : numbers) {
    const Page& page = pages_.at(number);
    for (std::int32_t i = 0; i < page_size; ++i) {
      const std::uint64_t count = page[static_cast<std::size_t>(i)];
      if (count > 0) counts.push_back({number * page_size + i, count});
    }
  }
  return counts;
}

SketchedOrder::SketchedOrder(const QuantileSketch& sketch) : counts_(sketch.counts()) {
  std::uint64_t sum = 0;
  for (const QuantileSketch::Count& count : counts_) sums_.push_back(sum += count.count);
}

QuantileSketch::Bucket SketchedOrder::at(std::uint64_t rank) const {
  const auto found = std::lower_bound(sums_.begin(), sums_.end(), rank);
  if (rank == 0 || found == sums_.end()) throw std::invalid_argument("SketchedOrder: there is no such rank");
  return QuantileSketch::bounds_of(counts_[static_cast<std::size_t>(found - sums_.begin())].bucket);
}

double SketchedOrder::quantile(double p) const {
  const double h = static_cast<double>(size() - 1) * p;
  const auto below = static_cast<std::uint64_t>(h);
  const double low = at(below + 1).estimate();
  if (below + 1 >= size()) return low;
  return std::lerp(low, at(below + 2).estimate(), h - static_cast<double>(below));
}

SampleInterval SketchedOrder::between(const QuantileRanks& ranks) const {
  SampleInterval interval;
  if (ranks.low) interval.low = at(*ranks.low).low;
  if (ranks.high) interval.high = at(*ranks.high).high;
  return interval;
}

}  // namespace steerstat
