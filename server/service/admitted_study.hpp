#pragma once

#include <cstdint>
#include <string_view>

#include "service/service_limits.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes a spec that a client sent. One that names files is refused.
///
/// @param memory  [bytes] that running studies may need together
/// @throws BadSpec, LimitExceeded for a valid study that asks for more than the service grants; both with every mistake
Study admitted_study(std::string_view text, const ServiceLimits& limits, std::uint64_t memory);

}  // namespace steerstat
