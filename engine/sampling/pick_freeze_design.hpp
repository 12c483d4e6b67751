#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "sampling/design.hpp"

namespace steerstat {

/// The design behind Sobol' indices (statistics/pick_freeze.hpp): each row of another design gives variables + 2 draws,
/// one after the other: A, B, then for each variable i the draw AB_i, which is A with variable i taken from B.
///
/// Draw `row * variants() + variant`: a design of more rows begins with the draws of one of fewer.
class PickFreezeDesign : public Design {
 public:
  /// @param base       a design of 2 variables() variables: those of A, then those of B
  /// @param variables  of this design, > 0
  PickFreezeDesign(std::shared_ptr<const Design> base, std::size_t variables)
      : base_(std::move(base)), variables_(variables) {}

  /// Draws that a row gives.
  [[nodiscard]] static std::uint64_t variants(std::size_t variables) { return variables + 2; }

  [[nodiscard]] double coordinate(std::uint64_t draw, std::size_t variable) const override {
    const std::uint64_t variant = draw % variants(variables_);
    const bool of_b = variant == 1 || variant == variable + 2;
    return base_->coordinate(draw / variants(variables_), of_b ? variables_ + variable : variable);
  }

 private:
  std::shared_ptr<const Design> base_;
  std::size_t variables_;
};

}  // namespace steerstat
