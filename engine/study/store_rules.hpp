#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/errors.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Notes what a study that does not keep all rows asks of rows that it does not keep: Sobol' indices, the precision of
/// a quantile, intervals over cells that share their draws.
///
/// @param mistaken  names of what has mistakes of its own, of which nothing is said
void check_store(const Study& study, const std::vector<std::string>& mistaken, std::vector<SpecError>& errors);

}  // namespace steerstat
