#include "statistics/superaccumulator.hpp"

#include <bit>
#include <cmath>

#include "statistics/exact_sum.hpp"

namespace steerstat {
namespace {

constexpr int exponent_of_unit = -1075;                         // the first chunk counts halves of the least double
constexpr std::uint32_t most_pending = std::uint32_t{1} << 30;  // terms that 2^63 has room for, at 2^32 each
constexpr std::uint64_t low_half = (std::uint64_t{1} << 32) - 1;

}  // namespace

void Superaccumulator::add(double term) {
  const auto bits = std::bit_cast<std::uint64_t>(term);
  const std::uint64_t exponent = bits >> 52 & 0x7FFU;
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
  const std::uint64_t mantissa = exponent == 0 ? fraction : fraction | std::uint64_t{1} << 52;
  // term = mantissa * 2^(place - 1075), and the mantissa, so shifted, lies in three chunks.
  const std::uint64_t place = exponent == 0 ? 1 : exponent;
  const std::size_t chunk = place / 32;
  const unsigned shift = place % 32;
  const std::uint64_t shifted = mantissa >> (32 - shift);  // without its lowest 32 bits
  const auto low = static_cast<std::int64_t>(mantissa << shift & low_half);
  const auto middle = static_cast<std::int64_t>(shifted & low_half);
  const auto high = static_cast<std::int64_t>(shifted >> 32);
  const std::int64_t sign = bits >> 63 != 0 ? -1 : 1;
  chunks_[chunk] += sign * low;
  chunks_[chunk + 1] += sign * middle;
  chunks_[chunk + 2] += sign * high;
  if (++pending_ == most_pending) carry();
}

void Superaccumulator::add(const Superaccumulator& other) {
  carry();
  const Chunks added = other.chunks();
  for (std::size_t i = 0; i < chunk_count; ++i) chunks_[i] += added[i];
  pending_ = 1;
}

void Superaccumulator::carry() {
  for (std::size_t i = 0; i + 1 < chunk_count; ++i) {
    const std::int64_t carried = chunks_[i] >> 32;  // rounded down: what stays is not negative
    chunks_[i] -= carried * (std::int64_t{1} << 32);
    chunks_[i + 1] += carried;
  }
  pending_ = 0;
}

Superaccumulator::Chunks Superaccumulator::chunks() const {
  Superaccumulator carried = *this;
  carried.carry();
  return carried.chunks_;
}

Superaccumulator::Chunks Superaccumulator::negated(const Chunks& chunks) {
  Superaccumulator sum;
  for (std::size_t i = 0; i < chunk_count; ++i) sum.chunks_[i] = -chunks[i];
  return sum.chunks();
}

double Superaccumulator::part(std::int64_t chunk, std::size_t place) {
  return std::ldexp(static_cast<double>(chunk), exponent_of_unit + 32 * static_cast<int>(place));
}

double Superaccumulator::value() const {
  ExactSum sum;
  for_each_part([&sum](double part) { sum.add(part); });
  return sum.value();
}

}  // namespace steerstat
