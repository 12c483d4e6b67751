#include "sampling/stream.hpp"

#include <Random123/philox.h>

namespace steerstat {
namespace {

constexpr std::uint32_t low_half(std::uint64_t x) {
  return static_cast<std::uint32_t>(x & 0xffffffffU);
}
constexpr std::uint32_t high_half(std::uint64_t x) {
  return static_cast<std::uint32_t>(x >> 32U);
}

}  // namespace

std::array<std::uint32_t, 4> philox(const std::array<std::uint32_t, 4>& counter,
                                    const std::array<std::uint32_t, 2>& key) {
  const r123::Philox4x32_R<10> generator;
  const r123::Philox4x32_R<10>::ctr_type c{{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32_R<10>::key_type k{{key[0], key[1]}};
  const auto block = generator(c, k);
  return {block[0], block[1], block[2], block[3]};
}

std::uint64_t name_hash(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : name) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3U;
  }
  return hash;
}

double unit_interval(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12U) + 0.5) * 0x1p-52;
}

BlockStream::BlockStream(std::uint64_t seed, std::string_view name) : key_{low_half(seed), high_half(seed)} {
  const std::uint64_t hash = name_hash(name);
  name_ = {low_half(hash), high_half(hash)};
}

std::array<std::uint32_t, 4> BlockStream::at(std::uint64_t index) const {
  return philox({low_half(index), high_half(index), name_[0], name_[1]}, key_);
}

double UniformStream::at(std::uint64_t index) const {
  const auto block = blocks_.at(index);
  return unit_interval((std::uint64_t{block[1]} << 32U) | block[0]);
}

}  // namespace steerstat
