#include "store/hdf5.hpp"

#include <mutex>

namespace steerstat::hdf5 {
namespace {

std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
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
  library_mutex().lock();
  H5Eget_auto2(H5E_DEFAULT, &printer_, &printer_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session() {
  H5Eset_auto2(H5E_DEFAULT, printer_, printer_data_);
  library_mutex().unlock();
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
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
          "cannot create the group " + name};
}

Handle open_group(hid_t parent, const std::string& name) {
  return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, "cannot open the group " + name};
}

bool has_member(hid_t group, const std::string& name) {
  return checked(H5Lexists(group, name.c_str(), H5P_DEFAULT), "cannot look for " + name) > 0;
}

}  // namespace steerstat::hdf5
