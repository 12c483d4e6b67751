#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sampling/design.hpp"
#include "sampling/stream.hpp"

namespace steerstat {

/// Independent uniform draws. A variable's draws depend on the seed and its own name alone, so that adding a variable,
/// or draws, changes none of those that were there.
class MonteCarlo : public Design {
 public:
  MonteCarlo(std::uint64_t seed, std::span<const std::string> names);

  [[nodiscard]] double coordinate(std::uint64_t draw, std::size_t variable) const override;

 private:
  std::vector<UniformStream> streams_;  // one a variable
};

}  // namespace steerstat
