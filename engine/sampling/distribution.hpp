#pragma once

#include <cstddef>
#include <variant>
#include <vector>

namespace steerstat {

/// The closed interval that a distribution's draws lie in; an infinite bound is never drawn.
struct Support {
  double low;
  double high;
  bool includes_low{true};  ///< false where `low` itself is never drawn, as 0 by a lognormal
};

/// Uniform on [low, high], low < high.
struct Uniform {
  double low;
  double high;

  [[nodiscard]] double quantile(double u) const;
  [[nodiscard]] Support support() const { return {low, high}; }
  friend bool operator==(const Uniform&, const Uniform&) = default;
};

/// Normal.
struct Normal {
  double mean;
  double std;  ///< standard deviation, > 0

  [[nodiscard]] double quantile(double u) const;
  [[nodiscard]] Support support() const;
  friend bool operator==(const Normal&, const Normal&) = default;
};

/// Normal, conditioned on [low, high].
class TruncatedNormal {
 public:
  /// @param mean, std  of the normal before truncation, std > 0
  /// @param low, high  low < high, with bounds_hold_probability()
  TruncatedNormal(double mean, double std, double low, double high);

  /// Whether [low, high] comes within 8 standard deviations of the mean; beyond, the draws would be those of a tail
  /// that no plant has.
  static bool bounds_hold_probability(double mean, double std, double low, double high);

  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double std() const { return std_; }
  [[nodiscard]] double quantile(double u) const;
  [[nodiscard]] Support support() const { return {low_, high_}; }
  friend bool operator==(const TruncatedNormal&, const TruncatedNormal&) = default;

 private:
  double mean_;
  double std_;
  double low_;
  double high_;
  // Bounds above the mean are mirrored below it, where probabilities keep their relative accuracy.
  bool mirrored_;
  double below_;   // probability of the (mirrored) normal below the lower bound
  double within_;  // and between the bounds
};

/// exp of a normal: median * exp(sigma Z).
struct Lognormal {
  double median;  ///< > 0
  double sigma;   ///< > 0, standard deviation of the logarithm

  [[nodiscard]] double quantile(double u) const;
  [[nodiscard]] Support support() const;
  friend bool operator==(const Lognormal&, const Lognormal&) = default;
};

/// Triangular on [low, high] with its peak at mode, low <= mode <= high, low < high.
struct Triangular {
  double low;
  double mode;
  double high;

  [[nodiscard]] double quantile(double u) const;
  [[nodiscard]] Support support() const { return {low, high}; }
  friend bool operator==(const Triangular&, const Triangular&) = default;
};

/// Finitely many values, each with a probability proportional to its weight.
class Discrete {
 public:
  /// @param values   (n), n >= 1
  /// @param weights  (n), >= 0, with a positive finite sum
  Discrete(std::vector<double> values, std::vector<double> weights);

  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  [[nodiscard]] double quantile(double u) const;
  /// Of the values whose weight is positive.
  [[nodiscard]] Support support() const;
  friend bool operator==(const Discrete&, const Discrete&) = default;

 private:
  std::vector<double> values_;
  std::vector<double> weights_;
  std::vector<double> cumulative_;  // (n) sums of the weights up to each value, in the order given
  std::size_t last_{0};             // position of the last value with a positive weight
};

/// The distribution of one number of a spec. A value; all its functions are pure and thread-safe, and its draws are
/// the same bits on every machine.
struct Distribution {
  using Shape = std::variant<Uniform, Normal, TruncatedNormal, Lognormal, Triangular, Discrete>;

  Shape shape;
  bool relative{false};  ///< draws multiply the nominal value; quantile() and support() are those of the factor

  /// Inverse of the distribution function (a Discrete's in the order its values are given).
  /// @param u  in (0, 1)
  [[nodiscard]] double quantile(double u) const;
  [[nodiscard]] Support support() const;
  friend bool operator==(const Distribution&, const Distribution&) = default;
};

}  // namespace steerstat
