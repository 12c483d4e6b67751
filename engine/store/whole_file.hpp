#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <vector>

/// Files that are written whole or not at all, and read whole. Thread-safe.
namespace steerstat {

/// Whether a file may use the disk's reserve, see require_free_space(): small ones that tell of the others may.
enum class Reserve { stays, may_be_used };

/// Replaces the file at `path`: writes `.tmp-*` beside it, fsyncs, renames, and fsyncs the directory, so that after a
/// kill or a power cut there is the old file or the new one. Through a symbolic link, the file it names is replaced. A
/// device or a pipe is written to in place.
///
/// @param parts     the file's bytes, one part after the other
/// @param workshop  where `.tmp-*` stands instead: a directory of the same file system, for those who clear it later
/// @throws RunFailure naming the path and the reason; whatever stood there is then untouched
void write_whole_file(const std::filesystem::path& path, std::initializer_list<std::span<const std::byte>> parts,
                      const std::filesystem::path& workshop = {}, Reserve reserve = Reserve::stays);

/// Whether a `.tmp-*` is one that this process writes, or has written: another one's, where nobody else has the
/// directory, is what was left when it died.
bool is_own_temporary(const std::filesystem::path& path);

/// Makes what was created, renamed or deleted in a directory last. @throws RunFailure
void sync_directory(const std::filesystem::path& directory);

/// @throws RunFailure naming the path and the reason
std::vector<std::byte> read_whole_file(const std::filesystem::path& path);

}  // namespace steerstat
