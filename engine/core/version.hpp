#pragma once

#include <string_view>

namespace steerstat {

/// The engine's version, "MAJOR.MINOR.PATCH". Part of a study's identity: outcomes are the same bits only within one.
std::string_view engine_version();

}  // namespace steerstat
