#include "sampling/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/elementary.hpp"
#include "core/normal.hpp"
#include "sampling/normal_probability.hpp"

namespace steerstat {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

double Uniform::quantile(double u) const {
  return std::min(low + (high - low) * u, high);  // rounding may step over the upper bound
}

double Normal::quantile(double u) const {
  return mean + std * normal_quantile(u);
}

Support Normal::support() const {
  return {-infinity, infinity};
}

TruncatedNormal::TruncatedNormal(double mean, double std, double low, double high)
    : mean_(mean), std_(std), low_(low), high_(high), mirrored_(low > mean) {
  const double a = (low - mean) / std;
  const double b = (high - mean) / std;
  below_ = normal_probability(mirrored_ ? -b : a);
  within_ = normal_probability(mirrored_ ? -a : b) - below_;
}

bool TruncatedNormal::bounds_hold_probability(double mean, double std, double low, double high) {
  return low <= mean + 8.0 * std && high >= mean - 8.0 * std;
}

double TruncatedNormal::quantile(double u) const {
  const double z = mirrored_ ? -normal_quantile(below_ + (1.0 - u) * within_) : normal_quantile(below_ + u * within_);
  return std::clamp(mean_ + std_ * z, low_, high_);
}

double Lognormal::quantile(double u) const {
  return median * exponential(sigma * normal_quantile(u));
}

Support Lognormal::support() const {
  return {0.0, infinity, false};
}

double Triangular::quantile(double u) const {
  const double width = high - low;
  const double x = u * width < mode - low ? low + std::sqrt(u * width * (mode - low))
                                          : high - std::sqrt((1.0 - u) * width * (high - mode));
  return std::clamp(x, low, high);
}

Discrete::Discrete(std::vector<double> values, std::vector<double> weights)
    : values_(std::move(values)), weights_(std::move(weights)) {
  cumulative_.reserve(weights_.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    cumulative_.push_back(sum += weights_[i]);
    if (weights_[i] > 0.0) last_ = i;
  }
}

double Discrete::quantile(double u) const {
  // The first sum above u times the total; a value of weight 0 repeats the sum before it and is never the first. The
  // last value with a weight stands outside the search: it is the answer where rounding leaves no sum above.
  const auto end = cumulative_.begin() + static_cast<std::ptrdiff_t>(last_);
  const auto first = std::upper_bound(cumulative_.begin(), end, u * cumulative_.back());
  return values_[static_cast<std::size_t>(first - cumulative_.begin())];
}

Support Discrete::support() const {
  Support support{infinity, -infinity};
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (weights_[i] == 0.0) continue;
    support.low = std::min(support.low, values_[i]);
    support.high = std::max(support.high, values_[i]);
  }
  return support;
}

double Distribution::quantile(double u) const {
  return std::visit([u](const auto& s) { return s.quantile(u); }, shape);
}

Support Distribution::support() const {
  return std::visit([](const auto& s) { return s.support(); }, shape);
}

}  // namespace steerstat
