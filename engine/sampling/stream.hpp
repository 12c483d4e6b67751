#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace steerstat {

/// One block of Philox4x32-10 [Salmon 2011]: 128 random bits, a pure function of a counter and a key.
std::array<std::uint32_t, 4> philox(const std::array<std::uint32_t, 4>& counter,
                                    const std::array<std::uint32_t, 2>& key);

/// 64-bit FNV-1a hash [Fowler 2019] of a name: the same on every machine, for ever.
std::uint64_t name_hash(std::string_view name);

/// The centre of one of 2^52 equal cells of (0, 1), chosen by the upper 52 bits.
///
/// Every result is an exact double, strictly between 0 and 1, and 1 - unit_interval(bits) is one too: quantiles are
/// finite at both ends and symmetric draws stay symmetric. (53 bits would need centres that round to 1.)
double unit_interval(std::uint64_t bits);

/// Uniform draws of one variable: a counter-based stream, keyed by (seed, the variable's name, the draw's index).
///
/// Draw i is a pure function of the three, so it is the same whatever else is drawn, in whatever order, on whatever
/// thread. Philox's key is the seed; its counter is the draw's index (lower half) and the name's hash (upper half).
/// Immutable and thread-safe.
class UniformStream {
 public:
  /// @param name  the variable's dotted name, e.g. "plant.m1"
  UniformStream(std::uint64_t seed, std::string_view name);

  /// @return draw `index`, in (0, 1).
  [[nodiscard]] double at(std::uint64_t index) const;

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 2> name_;
};

}  // namespace steerstat
