#pragma once

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <span>

#include "store/hdf5.hpp"

/// HDF5 files held in memory. HDF5 never touches the disk: one that fills up under it takes the whole process along.
namespace steerstat::hdf5 {

/// The bytes of a file.
class Bytes {
 public:
  Bytes() = default;
  Bytes(void* allocated, std::size_t size) : data_(static_cast<std::byte*>(allocated)), size_(size) {}

  [[nodiscard]] std::span<const std::byte> span() const { return {data_.get(), size_}; }
  [[nodiscard]] std::byte* release() { return data_.release(); }

 private:
  struct Free {
    void operator()(std::byte* bytes) const { std::free(bytes); }
  };
  std::unique_ptr<std::byte, Free> data_;
  std::size_t size_{0};
};

/// A new file, written in memory.
class MemoryFile {
 public:
  MemoryFile();

  [[nodiscard]] hid_t id() const { return file_.id(); }

  /// Closes the file. @return all of its bytes @throws Problem
  Bytes close();

 private:
  // Where HDF5 leaves the file's bytes when it closes; it stays where it is when this object moves.
  std::unique_ptr<Bytes> closed_;
  Handle file_;
};

/// A file to be read. @param bytes  all of its bytes, not empty, which must outlive it @throws Problem
Handle open_in_memory(std::span<const std::byte> bytes);

/// A file to be read where it lies: what is not read of it costs nothing. @throws Problem
Handle open_on_disk(const std::filesystem::path& path);

}  // namespace steerstat::hdf5
