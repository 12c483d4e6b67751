#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <stdexcept>

#include "core/version.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

// SHA-256 in hexadecimal [NIST FIPS 180-4].
std::string sha256(const std::string& text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available from OpenSSL");
  }
  std::string hexadecimal;
  for (unsigned i = 0; i < size; ++i) hexadecimal += fmt::format("{:02x}", digest[i]);
  return hexadecimal;
}

}  // namespace

std::string spec_sha256(const Study& study) {
  return sha256(canonical_spec(study));
}

std::string population_sha256(const Study& study) {
  return sha256(canonical_population(study));
}

std::string study_id(const Study& study) {
  return sha256(fmt::format("{}\n{}", engine_version(), canonical_spec(study))).substr(0, 16);
}

}  // namespace steerstat
