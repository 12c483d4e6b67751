#include "store/attribute.hpp"

#include <memory>

namespace steerstat::hdf5 {
namespace {

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "cannot create a string type");
  checked(H5Tset_size(type.id(), H5T_VARIABLE), "cannot create a string type");
  checked(H5Tset_cset(type.id(), H5T_CSET_UTF8), "cannot create a string type");
  return type;
}

Handle scalar() {
  return {H5Screate(H5S_SCALAR), H5Sclose, "cannot create a scalar"};
}

void write_scalar(hid_t object, const std::string& name, NumberType type, const void* value) {
  const std::string what = "cannot write the attribute " + name;
  const Handle space = scalar();
  const Handle attribute(H5Acreate2(object, name.c_str(), type.stored, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         what);
  checked(H5Awrite(attribute.id(), type.native, value), what);
}

/// The attribute, found to be one scalar of the type `stored`.
Handle open_scalar(hid_t object, const std::string& name, hid_t stored) {
  const std::string what = "cannot read the attribute " + name;
  if (checked(H5Aexists(object, name.c_str()), what) == 0) throw Problem("there is no attribute " + name);
  Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose, what);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose, what);
  if (checked(H5Tequal(type.id(), stored), what) == 0 || H5Sget_simple_extent_type(space.id()) != H5S_SCALAR) {
    throw Problem("the attribute " + name + " has the wrong type");
  }
  return attribute;
}

void read_scalar(hid_t object, const std::string& name, NumberType type, void* value) {
  const Handle attribute = open_scalar(object, name, type.stored);
  checked(H5Aread(attribute.id(), type.native, value), "cannot read the attribute " + name);
}

}  // namespace

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  const Handle type = text_type();
  const char* const pointer = text.c_str();
  write_scalar(object, name, {type.id(), type.id()}, &pointer);
}

void write_attribute(hid_t object, const std::string& name, double value) {
  write_scalar(object, name, type_of(value), &value);
}

void write_attribute(hid_t object, const std::string& name, std::uint32_t value) {
  write_scalar(object, name, type_of(value), &value);
}

void write_attribute(hid_t object, const std::string& name, bool value) {
  const Handle type = boolean();
  const std::int8_t byte = value ? 1 : 0;
  write_scalar(object, name, {type.id(), type.id()}, &byte);
}

bool has_attribute(hid_t object, const std::string& name) {
  return checked(H5Aexists(object, name.c_str()), "cannot look for the attribute " + name) > 0;
}

std::string read_text_attribute(hid_t object, const std::string& name) {
  const Handle type = text_type();
  char* raw = nullptr;
  read_scalar(object, name, {type.id(), type.id()}, &raw);
  const std::unique_ptr<char, herr_t (*)(void*)> text(raw, [](void* memory) { return H5free_memory(memory); });
  return text ? std::string(text.get()) : std::string();
}

double read_real_attribute(hid_t object, const std::string& name) {
  double value = 0.0;
  read_scalar(object, name, type_of(value), &value);
  return value;
}

std::uint32_t read_integer_attribute(hid_t object, const std::string& name) {
  std::uint32_t value = 0;
  read_scalar(object, name, type_of(value), &value);
  return value;
}

bool read_flag_attribute(hid_t object, const std::string& name) {
  const Handle type = boolean();
  std::int8_t value = 0;
  read_scalar(object, name, {type.id(), type.id()}, &value);
  return value != 0;
}

}  // namespace steerstat::hdf5
