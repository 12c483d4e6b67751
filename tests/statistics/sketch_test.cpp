// Statistics of values that are not kept: exact sums and moments, order statistics within a bucket.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "statistics/clustered.hpp"
#include "statistics/exact_sum.hpp"
#include "statistics/moments.hpp"
#include "statistics/quantile_sketch.hpp"
#include "statistics/sample.hpp"

namespace steerstat {
namespace {

using Limits = std::numeric_limits<double>;

/// Of every magnitude and sign.
std::vector<double> wild_values(std::size_t count) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-1070, 990);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(std::ldexp(mantissa(generator), exponent(generator)));
  return values;
}

std::vector<double> usual_values(std::size_t count) {
  std::mt19937_64 generator(2);
  std::lognormal_distribution<double> size(2.0, 1.5);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(i % 7 == 0 ? -size(generator) : size(generator));
  return values;
}

TEST(Superaccumulator, IsTheRoundedExactSum) {
  ExactSum expected;
  Superaccumulator sum;
  for (const double x : wild_values(2000)) {
    expected.add(x);
    sum.add(x);
    ASSERT_EQ(sum.value(), expected.value());
  }
}

TEST(Superaccumulator, LosesNothingWhereTermsCancel) {
  Superaccumulator sum;
  const std::vector<double> ends{0x1p1000, 1.0, Limits::denorm_min(), -0x1p1000, -1.0};
  for (const double x : ends) sum.add(x);
  EXPECT_EQ(sum.value(), Limits::denorm_min());
  sum.add(-Limits::denorm_min());
  EXPECT_EQ(sum, Superaccumulator());
  sum.add(-0x1p-1073);
  EXPECT_EQ(sum.value(), -0x1p-1073) << "a negative sum";
  EXPECT_EQ(Superaccumulator(sum.chunks()), sum);
}

TEST(Superaccumulator, IsTheSameHoweverItsTermsAreSharedOut) {
  std::vector<double> values = wild_values(999);
  Superaccumulator whole;
  for (const double x : values) whole.add(x);
  std::shuffle(values.begin(), values.end(), std::mt19937_64(3));
  std::vector<Superaccumulator> parts(7);
  for (std::size_t i = 0; i < values.size(); ++i) parts[i * i % 7].add(values[i]);
  Superaccumulator joined;
  for (const Superaccumulator& part : parts) joined.add(part);
  EXPECT_EQ(joined, whole);
}

TEST(Moments, AreThoseOfTheSampleAndTheMeanToTheBit) {
  for (const std::size_t count : {1U, 2U, 3U, 1000U}) {
    const std::vector<double> values = usual_values(count);
    const SampleStatistics expected = *describe(values);
    Moments moments;
    for (const double x : values) moments.add(x);
    EXPECT_EQ(moments.count(), count);
    EXPECT_EQ(moments.mean(), expected.mean);
    EXPECT_EQ(moments.min(), expected.min);
    EXPECT_EQ(moments.max(), expected.max);
    ASSERT_EQ(moments.standard_deviation().has_value(), expected.std.has_value());
    if (!expected.std) continue;
    EXPECT_NEAR(*moments.standard_deviation(), *expected.std, 1e-15 * *expected.std);
  }
}

TEST(Moments, TellASpreadThatIsSmallBesideTheMean) {
  Moments moments;
  for (int i = 0; i < 1000; ++i) moments.add(1e9 + (i % 2 == 0 ? 0x1p-20 : -0x1p-20));
  EXPECT_NEAR(*moments.standard_deviation(), 0x1p-20 * std::sqrt(1000.0 / 999.0), 1e-18);
  Moments constant;
  for (int i = 0; i < 10; ++i) constant.add(0.1);
  EXPECT_EQ(constant.standard_deviation(), 0.0);
}

TEST(Moments, HaveNoSpreadWhereASquareIsNoDouble) {
  Moments moments;
  moments.add(std::nextafter(0x1p511, 0.0));
  moments.add(1.0);
  EXPECT_TRUE(moments.standard_deviation());
  moments.add(-0x1p511);
  EXPECT_FALSE(moments.standard_deviation());
  EXPECT_EQ(moments.min(), -0x1p511);
}

TEST(QuantileSketch, EveryValueLiesInItsBucketAndNearItsEstimate) {
  std::vector<double> values = wild_values(2000);
  for (const double x : {0.0, -0.0, 1.0, -1.0, 2047.0, 2048.0, Limits::max(), Limits::lowest(), Limits::min(),
                         Limits::denorm_min(), std::nextafter(Limits::min(), 0.0)}) {
    values.push_back(x);
  }
  for (const double x : values) {
    const std::int32_t number = QuantileSketch::bucket_of(x);
    ASSERT_TRUE(QuantileSketch::is_bucket(number));
    const QuantileSketch::Bucket bucket = QuantileSketch::bounds_of(number);
    if (std::abs(x) < Limits::min()) {
      EXPECT_EQ(bucket.estimate(), 0.0);
      continue;
    }
    EXPECT_LE(bucket.low, x);
    EXPECT_GE(bucket.high, x);
    EXPECT_LE(std::abs(bucket.estimate() - x), QuantileSketch::relative_error * std::abs(x)) << x;
  }
  for (int x = -2048; x <= 2048; ++x) {
    EXPECT_EQ(QuantileSketch::bounds_of(QuantileSketch::bucket_of(x)).estimate(), x);
  }
  EXPECT_FALSE(QuantileSketch::is_bucket(1));
  EXPECT_FALSE(QuantileSketch::is_bucket(QuantileSketch::bucket_of(Limits::max()) + 1));
  EXPECT_FALSE(QuantileSketch::is_bucket(std::numeric_limits<std::int32_t>::min()));
}

TEST(QuantileSketch, QuantilesAreThoseOfTheSampleWithinTheStatedError) {
  for (const std::size_t count : {1U, 2U, 10U, 5000U}) {
    std::vector<double> values = usual_values(count);
    QuantileSketch sketch;
    for (const double x : values) sketch.add(x);
    std::sort(values.begin(), values.end());
    const SketchedOrder order(sketch);
    ASSERT_EQ(order.size(), count);
    for (const double p : {0.0, 0.05, 0.3, 0.5, 0.95, 0.99, 1.0}) {
      const double exact = quantile(values, p);
      const double h = static_cast<double>(count - 1) * p;
      const auto next = std::min(static_cast<std::size_t>(h) + 1, count - 1);
      const double size = std::max(std::abs(values[static_cast<std::size_t>(h)]), std::abs(values[next]));
      EXPECT_NEAR(order.quantile(p), exact, QuantileSketch::relative_error * size);
    }
    const SampleInterval within = order.between({1, count});
    EXPECT_LE(*within.low, values.front());
    EXPECT_GE(*within.high, values.back());
    EXPECT_FALSE(order.between({}).low);
  }
}

TEST(QuantileSketch, IsTheSameHoweverItsValuesAreSharedOut) {
  const std::vector<double> values = usual_values(1000);
  QuantileSketch whole;
  std::vector<QuantileSketch> parts(3);
  for (std::size_t i = 0; i < values.size(); ++i) {
    whole.add(values[i]);
    parts[i % 3].add(values[i]);
  }
  QuantileSketch joined = parts[2];
  joined.add(parts[0]);
  EXPECT_NE(joined, whole);
  joined.add(parts[1]);
  EXPECT_EQ(joined, whole);
  QuantileSketch again;
  for (const QuantileSketch::Count& count : whole.counts()) again.add(count);
  EXPECT_EQ(again, whole);
}

TEST(EqualClusters, GiveTheIntervalsOfTheListOfThem) {
  std::mt19937_64 generator(4);
  constexpr std::uint64_t size = 5;
  std::vector<ClusterSum> clusters;
  EqualClusters sums;
  sums.size = size;
  for (int i = 0; i < 300; ++i) {
    const auto successes = static_cast<std::uint64_t>(generator() % 3 == 0 ? generator() % (size + 1) : size);
    clusters.push_back({size, static_cast<double>(successes)});
    ++sums.clusters;
    sums.successes += successes;
    sums.squares += successes * successes;
    EXPECT_NEAR(effective_trials_of_equal(sums, 0.95), effective_trials(clusters, 0.95), 1e-9);
  }
  for (const ProportionMethod method :
       {ProportionMethod::wilson, ProportionMethod::clopper_pearson, ProportionMethod::confidence_sequence}) {
    const ProportionInterval expected = clustered_proportion(method, clusters, 0.95);
    const ProportionInterval interval = equal_clusters_proportion(method, sums, 0.95);
    EXPECT_EQ(interval.estimate, expected.estimate);
    EXPECT_NEAR(interval.low, expected.low, 1e-12);
    EXPECT_NEAR(interval.high, expected.high, 1e-12);
  }
}

}  // namespace
}  // namespace steerstat
