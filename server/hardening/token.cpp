#include "hardening/token.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <vector>

#include "core/errors.hpp"

namespace steerstat {
namespace {

/// Compares in a time that depends on the lengths alone.
bool same(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

/// The credentials of a scheme, nothing where the header is of another one. Schemes are case-insensitive.
std::optional<std::string_view> credentials(std::string_view authorization, std::string_view scheme) {
  if (authorization.size() <= scheme.size() || authorization[scheme.size()] != ' ') return std::nullopt;
  for (std::size_t i = 0; i < scheme.size(); ++i) {
    if ((authorization[i] | 0x20) != scheme[i]) return std::nullopt;
  }
  authorization.remove_prefix(scheme.size());
  while (!authorization.empty() && authorization.front() == ' ') authorization.remove_prefix(1);
  return authorization;
}

std::string decode_base64(std::string_view text) {
  if (text.size() > 4096 || text.size() % 4 != 0 || text.empty()) return "";
  std::vector<unsigned char> bytes(text.size() / 4 * 3 + 1);
  const auto* input = reinterpret_cast<const unsigned char*>(text.data());
  const int length = EVP_DecodeBlock(bytes.data(), input, static_cast<int>(text.size()));
  if (length < 0) return "";
  std::string result(bytes.begin(), bytes.begin() + length);
  const auto padding = static_cast<std::size_t>(std::count(text.end() - 2, text.end(), '='));
  result.resize(result.size() - std::min(padding, result.size()));
  return result;
}

}  // namespace

std::string read_token_file(const std::string& path) {
  struct stat status {};
  std::ifstream file(path, std::ios::binary);
  if (!file || stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
    throw BadUsage("--token-file: cannot read " + path + "; name a file with a token in it");
  }
  // A group may read it: so are the files that systemd hands on as credentials.
  if ((status.st_mode & (S_IWGRP | S_IRWXO)) != 0) {
    throw BadUsage("--token-file: other users can get at " + path + " (a token is a secret); chmod 600 " + path);
  }
  std::string token;
  std::getline(file, token);
  if (!token.empty() && token.back() == '\r') token.pop_back();
  const bool visible = std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  std::string rest;
  if (token.size() < shortest_token || token.size() > 1024 || !visible || std::getline(file, rest)) {
    throw BadUsage("--token-file: " + path + " has no token (one line of at least " + std::to_string(shortest_token) +
                   " visible ASCII characters); make one with: openssl rand -hex 32 > " + path);
  }
  return token;
}

bool shows_token(std::string_view authorization, std::string_view token) {
  if (const auto shown = credentials(authorization, "bearer")) return same(*shown, token);
  if (const auto encoded = credentials(authorization, "basic")) {
    const std::string pair = decode_base64(*encoded);
    const std::size_t colon = pair.find(':');
    return colon != std::string::npos && same(std::string_view(pair).substr(colon + 1), token);
  }
  return false;
}

}  // namespace steerstat
