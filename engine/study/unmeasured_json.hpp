#pragma once

#include <string_view>

#include "study/reader_json.hpp"

namespace steerstat {

/// Notes a mistake where `metric` is one that a study with `"metrics": false` leaves out.
///
/// @param reader  the place that names it
void refuse_unmeasured(const Reader& reader, std::string_view metric);

}  // namespace steerstat
