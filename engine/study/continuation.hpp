#pragma once

#include <string>

#include "study/study.hpp"

namespace steerstat {

/// Whether every trial of `earlier` is the trial of the same index in `later`: both are the same study, but for how
/// many draws it has where a study with more draws begins with the trials of one with fewer.
bool continues(const Study& later, const Study& earlier);

/// SHA-256 of what decides the trials of a study, whatever their number: the same, 64 hexadecimal digits, for a study
/// and for all that it continues().
std::string trials_sha256(const Study& study);

}  // namespace steerstat
