#include "store/hdf5.hpp"

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace steerstat::hdf5 {
namespace {

/// Who may use the library: one thread, then the one that came next. A plain mutex may be had again and again by the
/// thread that has it.
class Line {
 public:
  void enter() {
    std::unique_lock lock(mutex_);
    const std::uint64_t number = next_++;
    moved_.wait(lock, [&] { return number == served_; });
    H5Eget_auto2(H5E_DEFAULT, &printer_, &printer_data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  void leave() {
    const std::lock_guard lock(mutex_);
    H5Eset_auto2(H5E_DEFAULT, printer_, printer_data_);
    ++served_;
    moved_.notify_all();
  }
  [[nodiscard]] bool somebody_waits() {
    const std::lock_guard lock(mutex_);
    return next_ - served_ > 1;
  }

 private:
  std::mutex mutex_{};
  std::condition_variable moved_{};
  std::uint64_t next_{0};
  std::uint64_t served_{0};
  H5E_auto2_t printer_{nullptr};  // of who is not in a session
  void* printer_data_{nullptr};
};

Line& line() {
  static Line line;
  return line;
}

herr_t append_description(unsigned, const H5E_error2_t* error, void* text) {
  auto& joined = *static_cast<std::string*>(text);
  if (error->desc == nullptr || *error->desc == '\0') return 0;
  if (!joined.empty()) joined += ": ";
  joined += error->desc;
  return 0;
}

}  // namespace

void fail(const std::string& what) {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, append_description, &text);
  H5Eclear2(H5E_DEFAULT);
  throw Problem(text.empty() ? what : what + " (HDF5: " + text + ")");
}

Session::Session() {
  line().enter();
}

Session::~Session() {
  line().leave();
}

void Session::give_way() {
  if (!line().somebody_waits()) return;
  line().leave();
  line().enter();
}

NumberType type_of(double) {
  return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
}
NumberType type_of(std::uint64_t) {
  return {H5T_STD_U64LE, H5T_NATIVE_UINT64};
}
NumberType type_of(std::uint32_t) {
  return {H5T_STD_U32LE, H5T_NATIVE_UINT32};
}
NumberType type_of(std::int64_t) {
  return {H5T_STD_I64LE, H5T_NATIVE_INT64};
}
NumberType type_of(std::int32_t) {
  return {H5T_STD_I32LE, H5T_NATIVE_INT32};
}

Handle enumeration(std::span<const std::string_view> names) {
  Handle type(H5Tenum_create(H5T_STD_U8LE), H5Tclose, "cannot create an enumeration");
  std::uint8_t value = 0;
  for (const std::string_view name : names) {
    checked(H5Tenum_insert(type.id(), std::string(name).c_str(), &value), "cannot fill an enumeration");
    ++value;
  }
  return type;
}

Handle boolean() {
  Handle type(H5Tenum_create(H5T_STD_I8LE), H5Tclose, "cannot create an enumeration");
  for (const std::int8_t value : {std::int8_t{0}, std::int8_t{1}}) {
    checked(H5Tenum_insert(type.id(), value == 0 ? "FALSE" : "TRUE", &value), "cannot fill an enumeration");
  }
  return type;
}

Handle create_group(hid_t parent, const std::string& name) {
  const std::string what = "cannot create the group " + name;
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, what);
  checked(H5Pset_obj_track_times(properties.id(), false), what);  // the same trials, the same bytes
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), H5Gclose, what};
}

Handle open_group(hid_t parent, const std::string& name) {
  return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, "cannot open the group " + name};
}

bool has_member(hid_t group, const std::string& name) {
  return checked(H5Lexists(group, name.c_str(), H5P_DEFAULT), "cannot look for " + name) > 0;
}

}  // namespace steerstat::hdf5
