#include "sampling/permutation.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace steerstat {
namespace {

// An even number: were both sides odd, every round would be an even permutation, and half of all orders out of reach.
std::uint64_t rows_for(std::uint64_t size) {
  const auto root = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(size))));
  return root + root % 2;
}

std::uint64_t double_rounds_for(std::uint64_t domain) {
  const auto bits = static_cast<std::uint64_t>(std::bit_width(domain) - 1);  // domain >= 2^bits, bits >= 1
  return std::max<std::uint64_t>(4, (40 + bits - 1) / bits);
}

// floor(x n / 2^64) of 64 random bits x: one of 0 ... n - 1, each with probability 1/n within 2^-64. n < 2^32
std::uint64_t scale(const std::array<std::uint32_t, 4>& block, std::uint64_t n) {
  return (block[1] * n + ((block[0] * n) >> 32U)) >> 32U;
}

}  // namespace

Permutation::Permutation(std::uint64_t size, std::uint64_t seed, std::string_view name)
    : rounds_(seed, name),
      size_(size),
      rows_(rows_for(size)),
      columns_((size + rows_ - 1) / rows_),
      double_rounds_(double_rounds_for(rows_ * columns_)) {}

std::uint64_t Permutation::at(std::uint64_t position) const {
  assert(position < size_);
  std::uint64_t element = position;
  do {
    std::uint64_t row = element / columns_;
    std::uint64_t column = element % columns_;
    for (std::uint64_t round = 0; round < 2 * double_rounds_; round += 2) {
      row = (row + scale(rounds_.at((round << 32U) | column), rows_)) % rows_;
      column = (column + scale(rounds_.at(((round + 1) << 32U) | row), columns_)) % columns_;
    }
    element = row * columns_ + column;
  } while (element >= size_);
  return element;
}

}  // namespace steerstat
