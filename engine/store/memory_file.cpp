#include "store/memory_file.hpp"

#include <atomic>
#include <cstring>
#include <string>
#include <vector>

namespace steerstat::hdf5 {
namespace {

constexpr std::size_t growth = std::size_t{4} << 20;  // by how much a file's memory grows at a time

/// HDF5 tells in-memory files apart by name alone.
std::string unused_name() {
  static std::atomic<std::uint64_t> count{0};
  return "steerstat-" + std::to_string(count++);
}

Handle access_in_memory() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "cannot set up file access");
  checked(H5Pset_fapl_core(access.id(), growth, false), "cannot keep the file in memory");
  // The format of 1.10, whose metadata and chunk indices carry checksums; later versions of HDF5 write it the same.
  checked(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110), "cannot choose the format of HDF5 1.10");
  return access;
}

/// What HDF5 calls to manage a file's memory. It gives the memory up when the file is closed: then it is kept instead,
/// the only way to a finished file's bytes (H5Fget_file_image leaves the superblock with a wrong checksum).
H5FD_file_image_callbacks_t keeping_in(Bytes& closed) {
  using Operation = H5FD_file_image_op_t;
  H5FD_file_image_callbacks_t callbacks{};
  callbacks.image_malloc = [](size_t size, Operation, void*) { return std::malloc(size); };
  callbacks.image_memcpy = [](void* to, const void* from, size_t size, Operation, void*) {
    return std::memcpy(to, from, size);
  };
  callbacks.image_realloc = [](void* memory, size_t size, Operation, void*) { return std::realloc(memory, size); };
  callbacks.image_free = [](void* memory, Operation operation, void* data) -> herr_t {
    if (operation == H5FD_FILE_IMAGE_OP_FILE_CLOSE) {
      *static_cast<Bytes*>(data) = Bytes(memory, 0);
    } else {
      std::free(memory);
    }
    return 0;
  };
  callbacks.udata_copy = [](void* data) { return data; };
  callbacks.udata_free = [](void*) -> herr_t { return 0; };
  callbacks.udata = &closed;
  return callbacks;
}

/// What HDF5 calls to have a file's memory, for one that is only read: it gets the very bytes, wherever it would copy
/// them, which is four times on the way to an open file.
H5FD_file_image_callbacks_t lending(std::span<const std::byte> bytes) {
  using Operation = H5FD_file_image_op_t;
  H5FD_file_image_callbacks_t callbacks{};
  callbacks.image_malloc = [](size_t, Operation, void* lent) { return lent; };
  callbacks.image_memcpy = [](void* to, const void*, size_t, Operation, void*) { return to; };
  callbacks.image_realloc = [](void*, size_t, Operation, void*) -> void* { return nullptr; };  // it does not grow
  callbacks.image_free = [](void*, Operation, void*) -> herr_t { return 0; };
  callbacks.udata_copy = [](void* lent) { return lent; };
  callbacks.udata_free = [](void*) -> herr_t { return 0; };
  callbacks.udata = const_cast<std::byte*>(bytes.data());  // nothing writes to a file that is opened to be read
  return callbacks;
}

Handle create(Bytes& closed) {
  const Handle access = access_in_memory();
  H5FD_file_image_callbacks_t callbacks = keeping_in(closed);
  checked(H5Pset_file_image_callbacks(access.id(), &callbacks), "cannot keep the file in memory");
  const char* const what = "cannot create the file in memory";
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, what);
  checked(H5Pset_obj_track_times(creation.id(), false), what);  // of the root group: the same trials, the same bytes
  return {H5Fcreate(unused_name().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose, what};
}

/// The end-of-file address in the superblock, version 2 or 3 [The HDF Group, HDF5 File Format Specification 3.0, II.A].
std::uint64_t end_of_file(const std::byte* file) {
  constexpr std::size_t place = 28;
  std::uint64_t end = 0;
  for (std::size_t i = 8; i-- > 0;) end = end << 8 | std::to_integer<std::uint64_t>(file[place + i]);
  return end;
}

}  // namespace

MemoryFile::MemoryFile() : closed_(std::make_unique<Bytes>()), file_(create(*closed_)) {}

Bytes MemoryFile::close() {
  file_.close();
  std::byte* const memory = closed_->release();
  if (memory == nullptr) throw Problem("HDF5 did not leave the file in memory");
  return {memory, end_of_file(memory)};
}

Handle open_in_memory(std::span<const std::byte> bytes) {
  const Handle access = access_in_memory();
  H5FD_file_image_callbacks_t callbacks = lending(bytes);
  checked(H5Pset_file_image_callbacks(access.id(), &callbacks), "cannot keep the file in memory");
  checked(H5Pset_file_image(access.id(), callbacks.udata, bytes.size()), "cannot keep the file in memory");
  return {H5Fopen(unused_name().c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose, "cannot open it as HDF5"};
}

Handle open_on_disk(const std::filesystem::path& path) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "cannot set up file access");
  checked(H5Pset_fapl_sec2(access.id()), "cannot set up file access");
  // Nobody writes to our files, and not every file system can lock.
  checked(H5Pset_file_locking(access.id(), false, true), "cannot do without a lock of the file");
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose, "cannot open it as HDF5"};
}

}  // namespace steerstat::hdf5
