#pragma once

#include <array>
#include <cstdint>

namespace steerstat {

/// The exact sum of any number of doubles, in fixed point over the whole range of the type [Neal 2015]: adding is
/// exact, so that neither the order of the terms nor how they were shared out among several sums makes a difference, to
/// the bit. Costs a few nanoseconds a term and half a kilobyte, however many terms there are.
class Superaccumulator {
 public:
  /// 32 bits each of the fixed-point number, the least significant first; the last takes the sign and what overflows.
  static constexpr std::size_t chunk_count = 67;
  using Chunks = std::array<std::int64_t, chunk_count>;

  Superaccumulator() = default;

  /// A sum as chunks() gave it.
  explicit Superaccumulator(const Chunks& chunks) : chunks_(chunks), pending_(1) { carry(); }

  /// @param term  finite
  void add(double term);

  /// Adds all terms of another sum.
  void add(const Superaccumulator& other);

  /// The sum of all terms, rounded to nearest, ties to even. The sum must not overflow.
  [[nodiscard]] double value() const;

  /// Hands out doubles whose exact sum this is.
  template <class Take>
  void for_each_part(const Take& take) const {
    const Chunks chunks = this->chunks();
    // Of a negative sum those of its magnitude: its own chunks are its magnitude's complement, up to beyond any double.
    const bool is_negative = chunks.back() < 0;
    const Chunks size = is_negative ? negated(chunks) : chunks;
    for (std::size_t i = chunk_count; i-- > 0;) {
      if (size[i] != 0) take(part(is_negative ? -size[i] : size[i], i));
    }
  }

  /// The sum itself: the same chunks for the same sum, however it came about.
  [[nodiscard]] Chunks chunks() const;

  friend bool operator==(const Superaccumulator& a, const Superaccumulator& b) { return a.chunks() == b.chunks(); }

 private:
  void carry();
  static Chunks negated(const Chunks& chunks);
  static double part(std::int64_t chunk, std::size_t place);

  Chunks chunks_{};           // each below 2^63 in size until carry()
  std::uint32_t pending_{0};  // terms since then
};

}  // namespace steerstat
