#include "sampling/correlated_design.hpp"

#include <utility>

#include "core/normal.hpp"
#include "sampling/normal_probability.hpp"

namespace steerstat {
CorrelatedDesign::CorrelatedDesign(std::shared_ptr<const Design> independent, const CorrelationFactor& factor)
    : independent_(std::move(independent)) {
  for (std::size_t row = factor.size; row-- > 0;) {
    Dependent dependent{row, {}};
    for (std::size_t column = 0; column <= row; ++column) {
      if (factor.at(row, column) != 0.0) dependent.terms.push_back({column, factor.at(row, column)});
    }
    if (dependent.terms.size() > 1) dependents_.push_back(std::move(dependent));
  }
}

double CorrelatedDesign::coordinate(std::uint64_t draw, std::size_t variable) const {
  for (const Dependent& dependent : dependents_) {
    if (dependent.variable != variable) continue;
    double z = 0.0;
    for (const Term& term : dependent.terms) {
      z += term.weight * normal_quantile(independent_->coordinate(draw, term.variable));
    }
    return coordinate_of_normal(z);
  }
  return independent_->coordinate(draw, variable);
}

void CorrelatedDesign::place(std::uint64_t draw, std::span<double> point) const {
  independent_->place(draw, point);
  // From the last to the first, so that a sum finds the variables before it as they were drawn.
  for (const Dependent& dependent : dependents_) {
    double z = 0.0;
    for (const Term& term : dependent.terms) z += term.weight * normal_quantile(point[term.variable]);
    point[dependent.variable] = coordinate_of_normal(z);
  }
}

}  // namespace steerstat
