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

/// Random blocks of one purpose: a counter-based stream, keyed by (seed, a name, the block's index).
///
/// Block i is a pure function of the three, so it is the same whatever else is drawn, in whatever order, on whatever
/// thread. Philox's key is the seed; its counter is the block's index (lower half) and the name's hash (upper half).
/// Immutable and thread-safe.
class BlockStream {
 public:
  /// @param name  what the blocks are for; streams of different names are independent
  BlockStream(std::uint64_t seed, std::string_view name);

  /// @return the 128 random bits of block `index`.
  [[nodiscard]] std::array<std::uint32_t, 4> at(std::uint64_t index) const;

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 2> name_;
};

/// Uniform draws of one variable: draw i is taken from block i of the stream of the variable's name, so that it is the
/// same whatever else is drawn. Immutable and thread-safe.
class UniformStream {
 public:
  /// @param name  the variable's dotted name, e.g. "plant.m1"
  UniformStream(std::uint64_t seed, std::string_view name) : blocks_(seed, name) {}

  /// @return draw `index`, in (0, 1).
  [[nodiscard]] double at(std::uint64_t index) const;

 private:
  BlockStream blocks_;
};

}  // namespace steerstat
