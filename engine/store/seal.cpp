#include "store/seal.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/errors.hpp"

namespace steerstat {
namespace {

constexpr std::string_view mark = "steerstat-sha256:";
constexpr std::size_t seal_size = mark.size() + 64 + 1;

std::string reason(const std::error_code& error) {
  return error ? error.message() : std::generic_category().message(errno);
}

/// A SHA-256 of bytes that come part by part.
class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(std::span<const std::byte> bytes) {
    require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  std::string seal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    std::string text(mark);
    for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
    return text + '\n';
  }

 private:
  static void require(bool works) {
    if (!works) throw std::runtime_error("SHA-256 is not available from OpenSSL");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string seal_of(std::span<const std::byte> bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.seal();
}

bool is_sealed(const std::filesystem::path& path) {
  constexpr std::uint64_t part = std::uint64_t{1} << 20U;
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) throw RunFailure(fmt::format("cannot read {} ({})", path.string(), reason(error)));
  if (size < seal_size) return false;
  std::vector<char> buffer(part);
  const auto read = [&](std::uint64_t count) {
    if (!file.read(buffer.data(), static_cast<std::streamsize>(count))) {
      throw RunFailure(fmt::format("cannot read {} (it ends early, or the disk fails)", path.string()));
    }
    return std::as_bytes(std::span(buffer).first(count));
  };
  Digest digest;
  for (std::uint64_t left = size - seal_size; left > 0;) {
    const std::uint64_t count = std::min(left, part);
    digest.add(read(count));
    left -= count;
  }
  const auto seal = read(seal_size);
  const std::string expected = digest.seal();
  return std::equal(seal.begin(), seal.end(), std::as_bytes(std::span(expected)).begin());
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
