#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace steerstat {

/// What of a metric a gate looks at.
enum class Quantity : std::uint8_t { estimate, ci_low, ci_high, mean, min, p05, p50, p95, p99, max, count };
inline constexpr std::array<std::string_view, 11> quantity_names{"estimate", "ci_low", "ci_high", "mean", "min",  "p05",
                                                                 "p50",      "p95",    "p99",     "max",  "count"};

enum class Relation : std::uint8_t { less, less_equal, greater, greater_equal };
inline constexpr std::array<std::string_view, 4> relation_names{"<", "<=", ">", ">="};

/// What a gate demands: `quantity relation bound`, as in `p95 < 120`.
struct GateExpression {
  Quantity quantity{};
  Relation relation{};
  double bound{};  ///< finite

  [[nodiscard]] bool holds(double x) const;
  /// Whether the demand is for large values: > or >=.
  [[nodiscard]] bool wants_more() const { return relation >= Relation::greater; }

  friend bool operator==(const GateExpression&, const GateExpression&) = default;
};

/// The expression as text, "ci_low >= 0.99": the quantity first, the bound in the fewest digits that read back.
std::string expression_text(const GateExpression& expression);

/// A demand on a study's statistics.
struct Gate {
  std::string metric;  ///< of metrics() or rate_names()
  GateExpression expression;
  bool each_cell{false};  ///< judged in each cell on its own, not over all trials
  struct SweptValue {
    std::string input;  ///< dotted, swept
    double value;       ///< one of the sweep's
    friend bool operator==(const SweptValue&, const SweptValue&) = default;
  };
  std::vector<SweptValue> cell;  ///< judged in each cell with these values; empty: no such choice

  friend bool operator==(const Gate&, const Gate&) = default;
};

/// How a run is held against a baseline's success rate.
struct BaselineTest {
  double level{0.05};   ///< most probable share of false alarms where the rate has not dropped
  double power{0.8};    ///< the chance with which the smallest detectable drop, as reported, is found
  double margin{0.02};  ///< a drop this large must be ruled out for a pass

  friend bool operator==(const BaselineTest&, const BaselineTest&) = default;
};

/// The quantities that a rate has: estimate, ci_low, ci_high, count.
std::span<const std::string_view> rate_quantities();

/// The quantities that a metric has: mean, min, p05, p50, p95, p99, max, count.
std::span<const std::string_view> sample_quantities();

}  // namespace steerstat
