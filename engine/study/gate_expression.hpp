#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "study/gate.hpp"

namespace steerstat {

/// Where a gate's expression stops making sense.
struct GateSyntaxError {
  std::size_t position{};  ///< in characters, counted from 1
  std::string found;       ///< what stands there; empty at the end of the text
  std::string wanted;      ///< "a number"
};

/// Parses one comparison of a quantity with a number, in either order:
///
///     expression = quantity comparison number | number comparison quantity
///     comparison = "<" | "<=" | ">" | ">="
///
/// A quantity is one of quantity_names; a number is as in JSON, finite. White space may stand between the three. What
/// comes back has the quantity first: `120 > p95` is `p95 < 120`.
///
/// @param text  UTF-8
std::variant<GateExpression, GateSyntaxError> parse_gate_expression(std::string_view text);

}  // namespace steerstat
