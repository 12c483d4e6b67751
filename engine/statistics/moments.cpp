#include "statistics/moments.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/exact_sum.hpp"

namespace steerstat {
namespace {

constexpr double too_large_to_square = 0x1p511;

/// Adds a * b exactly, but for what lies below the least double.
void add_product(double a, double b, ExactSum& sum) {
  const double product = a * b;
  sum.add(product);
  sum.add(std::fma(a, b, -product));
}

}  // namespace

void Moments::add(double value) {
  ++count_;
  min_ = std::min(min_, value);
  max_ = std::max(max_, value);
  sum_.add(value);
  if (std::abs(value) >= too_large_to_square) return;
  const double square = value * value;
  squares_.add(square);
  squares_.add(std::fma(value, value, -square));
}

void Moments::add(const Moments& other) {
  count_ += other.count_;
  min_ = std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
  sum_.add(other.sum_);
  squares_.add(other.squares_);
}

double Moments::mean() const {
  return std::clamp(sum_.value() / static_cast<double>(count_), min_, max_);
}

std::optional<double> Moments::standard_deviation() const {
  if (count_ < 2 || std::max(std::abs(min_), std::abs(max_)) >= too_large_to_square) return std::nullopt;
  // Sum of (x - m)^2 = sum of x^2 - 2 m (sum of x) + n m^2, in exact terms: nothing is lost where they cancel.
  const double m = mean();
  const auto n = static_cast<double>(count_);
  ExactSum deviations;
  squares_.for_each_part([&](double part) { deviations.add(part); });
  sum_.for_each_part([&](double part) { add_product(-2.0 * m, part, deviations); });
  const double square = m * m;
  add_product(n, square, deviations);
  add_product(n, std::fma(m, m, -square), deviations);
  return std::sqrt(std::max(deviations.value(), 0.0) / (n - 1.0));
}

Moments Moments::of(std::uint64_t count, double min, double max, const Superaccumulator& sum,
                    const Superaccumulator& squares) {
  Moments moments;
  moments.count_ = count;
  moments.min_ = min;
  moments.max_ = max;
  moments.sum_ = sum;
  moments.squares_ = squares;
  return moments;
}

}  // namespace steerstat
