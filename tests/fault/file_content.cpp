#include "file_content.hpp"

#include <hdf5.h>

#include <stdexcept>
#include <vector>

namespace steerstat::testing {
namespace {

using Content = std::map<std::string, std::string>;

template <class Code>
Code checked(Code code) {
  if (code < 0) throw std::runtime_error("HDF5 cannot read the file");
  return code;
}

std::string encoded(hid_t type) {
  std::size_t size = 0;
  checked(H5Tencode(type, nullptr, &size));
  std::string bytes(size, '\0');
  checked(H5Tencode(type, bytes.data(), &size));
  return bytes;
}

std::string attribute_value(hid_t attribute) {
  const hid_t type = checked(H5Aget_type(attribute));
  std::string value = encoded(type);
  if (checked(H5Tis_variable_str(type)) > 0) {
    char* text = nullptr;
    checked(H5Aread(attribute, type, &text));
    value += text;
    checked(H5free_memory(text));
  } else {
    std::string bytes(H5Tget_size(type), '\0');
    checked(H5Aread(attribute, type, bytes.data()));
    value += bytes;
  }
  H5Tclose(type);
  return value;
}

void add_attributes(hid_t object, const std::string& path, Content& content) {
  H5O_info_t info;
  checked(H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS));
  for (hsize_t i = 0; i < info.num_attrs; ++i) {
    const hid_t attribute =
        checked(H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT));
    std::string name(static_cast<std::size_t>(checked(H5Aget_name(attribute, 0, nullptr))), '\0');
    checked(H5Aget_name(attribute, name.size() + 1, name.data()));
    content[path + "@" + name] = attribute_value(attribute);
    H5Aclose(attribute);
  }
}

std::string dataset_value(hid_t dataset) {
  const hid_t type = checked(H5Dget_type(dataset));
  const hid_t space = checked(H5Dget_space(dataset));
  const auto rows = static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space)));
  std::string bytes(rows * H5Tget_size(type), '\0');
  if (rows > 0) checked(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()));
  bytes = encoded(type) + bytes;
  H5Sclose(space);
  H5Tclose(type);
  return bytes;
}

void add_object(hid_t parent, const std::string& path, Content& content) {
  add_attributes(parent, path, content);
  if (H5Iget_type(parent) == H5I_DATASET) {
    content[path] = dataset_value(parent);
    return;
  }
  H5G_info_t info;
  checked(H5Gget_info(parent, &info));
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    std::string name(static_cast<std::size_t>(checked(
                         H5Lget_name_by_idx(parent, ".", H5_INDEX_NAME, H5_ITER_INC, i, nullptr, 0, H5P_DEFAULT))),
                     '\0');
    checked(H5Lget_name_by_idx(parent, ".", H5_INDEX_NAME, H5_ITER_INC, i, name.data(), name.size() + 1, H5P_DEFAULT));
    const hid_t child = checked(H5Oopen(parent, name.c_str(), H5P_DEFAULT));
    add_object(child, path + "/" + name, content);
    H5Oclose(child);
  }
}

}  // namespace

std::map<std::string, std::string> content_of(const std::filesystem::path& path) {
  Content content;
  const hid_t file = checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  const hid_t root = checked(H5Gopen2(file, "/", H5P_DEFAULT));
  add_object(root, "", content);
  H5Gclose(root);
  H5Fclose(file);
  return content;
}

std::map<std::string, std::string> lasting_content_of(const std::filesystem::path& path) {
  Content content = content_of(path);
  for (const char* name : {"@created", "@wall_s"}) {
    if (content.erase(name) != 1) throw std::runtime_error(path.string() + " has no attribute " + name);
  }
  return content;
}

}  // namespace steerstat::testing
