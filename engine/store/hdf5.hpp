#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

/// The few things of HDF5 that result files are made of: every return code checked, every object closed. Not
/// thread-safe: one thread at a time uses HDF5 (see Session).
namespace steerstat::hdf5 {

/// What went wrong, with HDF5's own words where it was HDF5 that failed. Says no file: whoever knows its name adds it.
class Problem : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws a Problem of `what` and the messages on HDF5's error stack.
[[noreturn]] void fail(const std::string& what);

/// @return `code`, which HDF5 makes negative to say that it failed. @throws Problem then, saying `what`
template <class Code>
Code checked(Code code, const std::string& what) {
  if (code < 0) fail(what);
  return code;
}

/// The right to use HDF5, held by one thread at a time, in the order of coming; meanwhile HDF5 prints no errors of its
/// own.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Lets those who wait go first, and comes back with the right. For whoever has it and works for long.
  static void give_way();
};

/// An open HDF5 object, closed at the end of its scope.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  /// @throws Problem where `id` is negative, saying `what`
  Handle(hid_t id, Close closer, const std::string& what) : id_(checked(id, what)), close_(closer) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;

  [[nodiscard]] hid_t id() const { return id_; }

  /// Closes now, when a failure can still be told. @throws Problem
  void close() { checked(close_(std::exchange(id_, -1)), "cannot close"); }

 private:
  hid_t id_;
  Close close_;
};

/// How a number stands in the file and in memory.
struct NumberType {
  hid_t stored;
  hid_t native;
};
NumberType type_of(double);
NumberType type_of(std::uint64_t);
NumberType type_of(std::uint32_t);
NumberType type_of(std::int64_t);
NumberType type_of(std::int32_t);

/// An enumeration stored as unsigned bytes: names[i] is i.
Handle enumeration(std::span<const std::string_view> names);

/// The enumeration {FALSE, TRUE} that h5py reads as a bool.
Handle boolean();

Handle create_group(hid_t parent, const std::string& name);
Handle open_group(hid_t parent, const std::string& name);

/// Whether a group has something called `name`. @throws Problem
bool has_member(hid_t group, const std::string& name);

}  // namespace steerstat::hdf5
