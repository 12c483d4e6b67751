#pragma once

#include "study/reader_json.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes a spec's `retain`: of which trials the trajectories are kept. @return with defaults where mistakes were
/// noted
Retention decode_retention(const Reader& reader);

}  // namespace steerstat
