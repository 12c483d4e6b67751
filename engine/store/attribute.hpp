#pragma once

#include <string>

#include "store/hdf5.hpp"

/// Scalar attributes of files and datasets.
namespace steerstat::hdf5 {

/// A UTF-8 string of variable length, which h5py reads as str.
void write_attribute(hid_t object, const std::string& name, const std::string& text);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, std::uint32_t value);
void write_attribute(hid_t object, const std::string& name, bool value);

/// Whether there is an attribute called `name`. @throws Problem
bool has_attribute(hid_t object, const std::string& name);

/// Each reads an attribute of the very type that the function above writes. @throws Problem naming the attribute
std::string read_text_attribute(hid_t object, const std::string& name);
double read_real_attribute(hid_t object, const std::string& name);
std::uint32_t read_integer_attribute(hid_t object, const std::string& name);
bool read_flag_attribute(hid_t object, const std::string& name);

}  // namespace steerstat::hdf5
