#pragma once

#include <string>

#include "study/study.hpp"

namespace steerstat {

/// Reads and decodes a study spec.
///
/// @param name  the file, or "-" for standard input (whose relative file names are looked up in the current directory)
/// @throws BadUsage where the file cannot be read, or with every mistake in the spec, one a line
Study read_study(const std::string& name);

}  // namespace steerstat
