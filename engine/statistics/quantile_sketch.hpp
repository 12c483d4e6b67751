#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "statistics/sample_interval.hpp"

namespace steerstat {

/// Order statistics of values that are not kept, each known within a bucket. The buckets are fixed, 1,024 to each
/// doubling, so that sketches of parts add up to that of the whole, to the bit, in whatever order; the idea of
/// [Masson et al. 2019] with the digits of the double itself for the logarithm. What it takes grows with the range of
/// the values and not with their number: 8 KiB a doubling at most.
class QuantileSketch {
 public:
  /// Estimates are off by less than this share of their magnitude: a value stands for its bucket's end nearest to 0.
  /// Whole numbers up to 2,048 are exact. Values below 2.3e-308 in size count as 0.
  static constexpr double relative_error = 0x1p-10;

  /// Where an order statistic lies.
  struct Bucket {
    double low, high;  ///< ends, low <= value < high (of a negative one low < value <= high); both 0 for 0
    [[nodiscard]] double estimate() const { return low < 0.0 ? high : low; }
  };

  /// How many values a bucket has.
  struct Count {
    std::int32_t bucket;  ///< rises with the values
    std::uint64_t count;
    friend bool operator==(const Count&, const Count&) = default;
  };

  /// @param value  finite
  void add(double value) { ++count_at(bucket_of(value)); }
  void add(const QuantileSketch& other);
  void add(const Count& count) { count_at(count.bucket) += count.count; }

  /// The buckets that have values, ascending.
  [[nodiscard]] std::vector<Count> counts() const;

  static std::int32_t bucket_of(double value);
  static Bucket bounds_of(std::int32_t bucket);

  /// Whether there is such a bucket.
  static bool is_bucket(std::int32_t bucket);

  friend bool operator==(const QuantileSketch& a, const QuantileSketch& b) { return a.counts() == b.counts(); }

 private:
  static constexpr std::int32_t page_size = 64;
  using Page = std::array<std::uint64_t, page_size>;

  std::uint64_t& count_at(std::int32_t bucket) {
    return pages_[bucket >> 6][static_cast<std::size_t>(bucket & (page_size - 1))];
  }

  std::unordered_map<std::int32_t, Page> pages_;
};

/// The order statistics of a sketch.
class SketchedOrder {
 public:
  explicit SketchedOrder(const QuantileSketch& sketch);

  [[nodiscard]] std::uint64_t size() const { return sums_.empty() ? 0 : sums_.back(); }

  /// @param rank  from 1 to size()
  [[nodiscard]] QuantileSketch::Bucket at(std::uint64_t rank) const;

  /// The p-quantile as quantile() of the sorted values, of each order statistic's estimate. @param p  in [0, 1]
  [[nodiscard]] double quantile(double p) const;

  /// The interval between the order statistics at `ranks`, to the outer ends of their buckets.
  [[nodiscard]] SampleInterval between(const QuantileRanks& ranks) const;

 private:
  std::vector<QuantileSketch::Count> counts_;
  std::vector<std::uint64_t> sums_;  // of the counts up to each
};

}  // namespace steerstat
