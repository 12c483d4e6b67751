#include "store/seal.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

namespace steerstat {
namespace {

constexpr std::string_view mark = "steerstat-sha256:";
constexpr std::size_t seal_size = mark.size() + 64 + 1;

}  // namespace

std::string seal_of(std::span<const std::byte> bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available from OpenSSL");
  }
  std::string seal(mark);
  for (unsigned i = 0; i < size; ++i) seal += fmt::format("{:02x}", digest[i]);
  return seal + '\n';
}

std::optional<std::span<const std::byte>> without_seal(std::span<const std::byte> sealed) {
  if (sealed.size() < seal_size) return std::nullopt;
  const auto bytes = sealed.first(sealed.size() - seal_size);
  const std::string expected = seal_of(bytes);
  const auto seal = std::as_bytes(std::span(expected));
  if (!std::equal(seal.begin(), seal.end(), sealed.end() - seal_size)) return std::nullopt;
  return bytes;
}

}  // namespace steerstat
