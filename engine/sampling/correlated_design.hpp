#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sampling/correlation.hpp"
#include "sampling/design.hpp"

namespace steerstat {

/// Another design with its variables correlated by a Gaussian copula: their coordinates u become
/// Phi(L Phi^-1(u)), L the Cholesky factor of the correlations, which are those of the normal variables in between.
///
/// Every coordinate stays uniform. Those of variables that are correlated with none before them keep their bits, and
/// with them what the design makes of them, such as one draw a stratum; a variable correlated with earlier ones is a
/// mixture of theirs and its own.
class CorrelatedDesign : public Design {
 public:
  /// @param independent  the design whose coordinates are correlated
  /// @param factor       of the correlation matrix of all its variables
  CorrelatedDesign(std::shared_ptr<const Design> independent, const CorrelationFactor& factor);

  [[nodiscard]] double coordinate(std::uint64_t draw, std::size_t variable) const override;
  void place(std::uint64_t draw, std::span<double> point) const override;

 private:
  // A variable that depends on others: Phi of a weighted sum of their normal variables, its own the last.
  struct Term {
    std::size_t variable;
    double weight;
  };
  struct Dependent {
    std::size_t variable;
    std::vector<Term> terms;
  };

  std::shared_ptr<const Design> independent_;
  std::vector<Dependent> dependents_;  // from the last variable to the first
};

}  // namespace steerstat
