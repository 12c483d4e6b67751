#pragma once

#include <cstdint>
#include <string_view>

#include "sampling/stream.hpp"

namespace steerstat {

/// A random permutation of 0 ... size - 1 that needs no table: any element is computed from its position alone.
///
/// An unbalanced Feistel network on a rectangle of rows x columns >= size, whose round functions are blocks of a
/// counter-based stream; where it leaves 0 ... size - 1 it is applied again until it comes back, which is a
/// permutation too [Black and Rogaway 2002]. A double round takes a factor of rows x columns off what the law of two
/// elements still is from uniform; there are as many as bring it below 2^-40, and at least four. (Over all orders of
/// many elements no such network is uniform: there are more orders than keys.)
///
/// Immutable and thread-safe.
class Permutation {
 public:
  /// @param size  1 to 2^32
  /// @param name  whose permutation it is; different names and seeds give independent ones
  Permutation(std::uint64_t size, std::uint64_t seed, std::string_view name);

  /// @param position  < size
  [[nodiscard]] std::uint64_t at(std::uint64_t position) const;

 private:
  BlockStream rounds_;
  std::uint64_t size_;
  std::uint64_t rows_;
  std::uint64_t columns_;
  std::uint64_t double_rounds_;
};

}  // namespace steerstat
