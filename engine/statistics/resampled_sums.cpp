#include "statistics/resampled_sums.hpp"

#include <algorithm>
#include <bit>

namespace steerstat {
namespace {

constexpr std::size_t block_size = 8;

void add(const UnitSums& term, UnitSums& sums) {
  sums.count += term.count;
  sums.sum += term.sum;
  sums.count_squares += term.count_squares;
  sums.sum_squares += term.sum_squares;
  sums.squares += term.squares;
}

// Entry k: the sums over those units whose bits are set in k.
using SubsetSums = std::array<UnitSums, std::size_t{1} << block_size>;

void sum_subsets(std::span<const BinEntry> block, SubsetSums& subsets) {
  for (std::size_t unit = 0; unit < block.size(); ++unit) {
    const std::size_t bit = std::size_t{1} << unit;
    for (std::size_t subset = 0; subset < bit; ++subset) {
      subsets[bit + subset] = subsets[subset];
      subsets[bit + subset].add(block[unit]);
    }
  }
}

// Transposes an 8 x 8 matrix of bits, row r in byte r [Warren 2012, 7-3].
std::uint64_t transposed(std::uint64_t x) {
  const auto swap = [&](unsigned distance, std::uint64_t mask) {
    const std::uint64_t t = (x ^ (x >> distance)) & mask;
    x ^= t ^ (t << distance);
  };
  swap(7, 0x00aa00aa00aa00aaU);
  swap(14, 0x0000cccc0000ccccU);
  swap(28, 0x00000000f0f0f0f0U);
  return x;
}

}  // namespace

ResampledSums resampled_sums(std::span<const BinEntry> units, std::uint64_t seed) {
  ResampledSums result{};
  SubsetSums subsets{};
  for (std::size_t begin = 0; begin < units.size(); begin += block_size) {
    const std::span<const BinEntry> block = units.subspan(begin, std::min(block_size, units.size() - begin));
    sum_subsets(block, subsets);
    for (std::size_t batch = 0; batch < resample_batches; ++batch) {
      std::array<std::uint64_t, block_size> words{};
      for (std::size_t i = 0; i < block.size(); ++i) words[i] = resampling_word(seed, block[i].unit, batch);
      for (std::size_t byte = 0; byte < resamples_a_batch / 8; ++byte) {
        std::uint64_t rows = 0;
        for (std::size_t i = 0; i < block_size; ++i) rows |= (words[i] >> (8 * byte) & 0xffU) << (8 * i);
        const std::uint64_t columns = transposed(rows);
        for (std::size_t k = 0; k < 8; ++k) {
          add(subsets[columns >> (8 * k) & 0xffU], result[batch * resamples_a_batch + 8 * byte + k]);
        }
      }
    }
  }
  return result;
}

}  // namespace steerstat
