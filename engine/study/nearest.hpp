#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace steerstat {

/// How many letters must be inserted, removed, replaced or swapped with their neighbour to turn one word into the
/// other, capital letters counting as small ones.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word of `known` that a user most likely meant by `word`: the nearest one, where that is near.
/// @return nothing where no word differs in at most a third of its letters (but one is always allowed)
std::optional<std::string_view> nearest(std::string_view word, std::span<const std::string_view> known);

}  // namespace steerstat
