#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sampling/design.hpp"
#include "sampling/stream.hpp"

namespace steerstat {

/// One component of a proposal. It moves the standard normal variable z behind a coordinate, u = Phi(z): z becomes
/// shift + scale z.
struct ProposalDensity {
  struct Tilt {
    std::size_t variable;  ///< position in the design's list of names
    double shift;          ///< [standard deviations]
    double scale;          ///< > 0
  };
  double share;             ///< of the draws, > 0
  std::vector<Tilt> tilts;  ///< of distinct variables; the others are drawn as they are
};

/// Independent draws from a defensive mixture [Hesterberg 1995]: a share of them as MonteCarlo makes them, to the bit,
/// the others from components that look where failures are. A draw's weight is the density of the nominal draws over
/// that of the mixture, at the draw: a pure function of seed and index. It never exceeds 1 / nominal share, whatever
/// the components miss; its mean over the draws is 1.
///
/// Which component a draw is from is drawn by a stream of its own.
class Importance : public Design {
 public:
  /// @param components  whose shares and the nominal one's add up to 1, the nominal one > 0
  Importance(std::uint64_t seed, std::span<const std::string> names, std::vector<ProposalDensity> components);

  [[nodiscard]] double coordinate(std::uint64_t draw, std::size_t variable) const override;
  void place(std::uint64_t draw, std::span<double> point) const override;
  [[nodiscard]] double weight(std::uint64_t draw) const override;
  [[nodiscard]] bool is_nominal(std::uint64_t draw) const override { return component_of(draw) == nullptr; }

 private:
  [[nodiscard]] const ProposalDensity* component_of(std::uint64_t draw) const;
  [[nodiscard]] double normal(std::uint64_t draw, std::size_t variable, const ProposalDensity* component) const;

  std::vector<UniformStream> streams_;  // (variables)
  UniformStream choice_;
  std::vector<ProposalDensity> components_;
  double nominal_share_;
};

}  // namespace steerstat
