#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/study.hpp"

namespace steerstat {

/// A place where two specs say different things.
struct SpecDifference {
  std::string pointer;           ///< JSON pointer into the canonical specs
  std::optional<std::string> a;  ///< what stands there, as JSON text; nothing where the spec has no such place
  std::optional<std::string> b;

  friend bool operator==(const SpecDifference&, const SpecDifference&) = default;
};

/// Where the canonical specs of two studies differ, in the order of the pointers. Left out is what decides no outcome:
/// the name, how many trials are asked for, audited or kept, and how they are judged. Numbers are as the canonical spec
/// writes them.
std::vector<SpecDifference> spec_differences(const Study& a, const Study& b);

}  // namespace steerstat
