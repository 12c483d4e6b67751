#pragma once

#include <cstdint>
#include <filesystem>

namespace steerstat {

/// Refuses to fill a file system to the brim: a reserve stays free for whatever else lives on it, a 64th of it but at
/// most 64 MiB. File systems that do not tell how much is free pass.
///
/// @param directory  on the file system
/// @param bytes      to be written there
/// @throws RunFailure saying how much is free and how much is needed
void require_free_space(const std::filesystem::path& directory, std::uint64_t bytes);

}  // namespace steerstat
