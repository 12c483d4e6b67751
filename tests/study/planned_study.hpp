#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/plan.hpp"
#include "study/spec_json.hpp"

namespace steerstat {

inline Study planned_study(const std::string& spec) {
  return decode_study(spec, {});
}

inline Plan plan_of(const std::string& spec) {
  return Plan(planned_study(spec));
}

/// The drawn and swept values of a trial, in the order of varying().
inline std::vector<double> values_of(const Plan& plan, std::uint64_t index) {
  std::vector<double> values(plan.varying().size());
  plan.draw(index, values);
  return values;
}

}  // namespace steerstat
