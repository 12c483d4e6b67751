#include "sampling/sobol_sequence.hpp"

#include <bit>
#include <stdexcept>
#include <string>

#include "sampling/sobol_dimensions.hpp"

namespace steerstat {
namespace {

constexpr unsigned digits = SobolSequence::digits;
using DirectionNumbers = std::array<std::uint64_t, digits>;

static_assert(SobolSequence::most_dimensions == sobol_dimensions.size() + 1);

// The first dimension is the radical inverse: every m_k is 1.
DirectionNumbers first_directions() {
  DirectionNumbers directions{};
  for (unsigned k = 0; k < digits; ++k) directions[k] = std::uint64_t{1} << (digits - 1 - k);
  return directions;
}

// m_k = 2 a_1 m_(k-1) + 2^2 a_2 m_(k-2) + ... + 2^s m_(k-s) + m_(k-s), every + exclusive or, of the polynomial
// x^s + a_1 x^(s-1) + ... + a_(s-1) x + 1 [Joe and Kuo 2008, (2)]; the direction number is m_k / 2^k.
DirectionNumbers directions_of(const SobolDimension& dimension) {
  const std::size_t degree = dimension.degree();
  std::array<std::uint64_t, digits> m{};
  for (std::size_t k = 0; k < digits; ++k) {
    if (k < degree) {
      m[k] = dimension.initial[k];
      continue;
    }
    m[k] = m[k - degree];
    for (std::size_t i = 1; i <= degree; ++i) {
      if (((dimension.polynomial >> (degree - i)) & 1U) != 0) m[k] ^= m[k - i] << i;
    }
  }
  DirectionNumbers directions{};
  for (std::size_t k = 0; k < digits; ++k) directions[k] = m[k] << (digits - 1 - k);
  return directions;
}

}  // namespace

SobolSequence::SobolSequence(std::size_t dimensions) {
  if (dimensions > most_dimensions) {
    throw std::invalid_argument("SobolSequence: " + std::to_string(dimensions) + " dimensions, but there are " +
                                std::to_string(most_dimensions));
  }
  directions_.reserve(dimensions);
  for (std::size_t i = 0; i < dimensions; ++i) {
    directions_.push_back(i == 0 ? first_directions() : directions_of(sobol_dimensions[i - 1]));
  }
}

std::uint64_t SobolSequence::at(std::uint64_t point, std::size_t dimension) const {
  const DirectionNumbers& directions = directions_[dimension];
  std::uint64_t coordinate = 0;
  for (std::uint64_t gray = point ^ (point >> 1U); gray != 0; gray &= gray - 1) {
    coordinate ^= directions[static_cast<std::size_t>(std::countr_zero(gray))];
  }
  return coordinate;
}

}  // namespace steerstat
