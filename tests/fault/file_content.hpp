#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace steerstat::testing {

/// All that is in an HDF5 file, read with HDF5 alone: by the path of each dataset its type and its bytes, and by
/// "PATH@NAME" those of each attribute. @throws std::runtime_error
std::map<std::string, std::string> content_of(const std::filesystem::path& path);

/// The content of a result file but for what tells one run from another: when it was written and how long it took.
std::map<std::string, std::string> lasting_content_of(const std::filesystem::path& path);

}  // namespace steerstat::testing
