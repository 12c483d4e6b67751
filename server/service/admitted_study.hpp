#pragma once

#include <cstdint>
#include <vector>

#include "core/errors.hpp"
#include "service/service_limits.hpp"
#include "study/study.hpp"

namespace steerstat {

/// What a valid study asks for that the service does not grant, by place in its spec; nothing where it is taken.
/// @param memory  [bytes] that running studies may need together
std::vector<SpecError> excesses(const Study& study, const ServiceLimits& limits, std::uint64_t memory);

}  // namespace steerstat
