#pragma once

#include <string>

namespace steerstat::bench {

/// The processor, its clock and caches as the system tells, the compiler and its flags: several lines.
std::string description_of_machine();

}  // namespace steerstat::bench
