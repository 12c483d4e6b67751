#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"
#include "study/study.hpp"

namespace steerstat {

/// The JSON pointer to an input: "/plant/m1" of "plant.m1".
std::string pointer_to(const std::string& input_name);

/// Checks what no place of a spec shows alone: that the controller's numbers fit together (CONTROLLER.md section 5)
/// in every trial, that the sampling fits the inputs, and that the study is not too large.
///
/// @param study     decoded; a mistaken part has its default
/// @param mistaken  names of the inputs, and "nominal" and "sampling", that have mistakes of their own: no rule that
///                  involves them is checked
/// @param errors    gets the mistakes
void check_rules(const Study& study, const std::vector<std::string>& mistaken, std::vector<SpecError>& errors);

}  // namespace steerstat
