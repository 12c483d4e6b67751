#include "study/gate.hpp"

#include <fmt/format.h>

namespace steerstat {
namespace {

constexpr std::array<std::string_view, 4> of_rates{"estimate", "ci_low", "ci_high", "count"};
constexpr std::array<std::string_view, 8> of_samples{"mean", "min", "p05", "p50", "p95", "p99", "max", "count"};

}  // namespace

bool GateExpression::holds(double x) const {
  switch (relation) {
    case Relation::less:
      return x < bound;
    case Relation::less_equal:
      return x <= bound;
    case Relation::greater:
      return x > bound;
    default:
      return x >= bound;
  }
}

std::string expression_text(const GateExpression& expression) {
  return fmt::format("{} {} {}", quantity_names[static_cast<std::size_t>(expression.quantity)],
                     relation_names[static_cast<std::size_t>(expression.relation)], expression.bound);
}

std::span<const std::string_view> rate_quantities() {
  return of_rates;
}

std::span<const std::string_view> sample_quantities() {
  return of_samples;
}

}  // namespace steerstat
