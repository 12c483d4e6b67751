#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

/// The last line of a result file: a digest of everything before it. HDF5 ignores what follows its own bytes; a reader
/// that checks the line first never hands damaged bytes to the HDF5 library, which does not survive all of them.
namespace steerstat {

/// "steerstat-sha256:", the SHA-256 of `bytes` [NIST FIPS 180-4] in hexadecimal, and a line end.
std::string seal_of(std::span<const std::byte> bytes);

/// @return the bytes before the seal; nothing where there is no seal or another one
std::optional<std::span<const std::byte>> without_seal(std::span<const std::byte> sealed);

/// Whether a file ends in the seal of what comes before it. Reads all of it, and holds little in memory.
/// @throws RunFailure where it cannot be read
bool is_sealed(const std::filesystem::path& path);

}  // namespace steerstat
