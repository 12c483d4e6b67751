#pragma once

#include <string>
#include <variant>

#include "study/approximation.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Reads and decodes a study spec.
///
/// @param name  the file, or "-" for standard input (whose relative file names are looked up in the current directory)
/// @throws BadUsage where the file cannot be read, or with every mistake in the spec, one a line
Study read_study(const std::string& name);

/// The same for a spec of either kind; read_study() refuses an approximation study.
std::variant<Study, ApproximationStudy> read_any_study(const std::string& name);

}  // namespace steerstat
