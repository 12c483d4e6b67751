#include "store/column.hpp"

#include <algorithm>

#include "store/attribute.hpp"

namespace steerstat::hdf5 {
namespace {

/// Rows a chunk: 512 KiB of doubles, well inside HDF5's chunk cache of 1 MiB.
constexpr hsize_t most_chunk_rows = 65536;

/// @param rows  > 0
/// @return rows a chunk, for chunks of about the same size, since HDF5 stores the last one in full
hsize_t chunk_rows(hsize_t rows) {
  const hsize_t chunks = (rows + most_chunk_rows - 1) / most_chunk_rows;
  return (rows + chunks - 1) / chunks;
}

Handle creation_properties(hsize_t rows, bool compressed) {
  const std::string what = "cannot set up a dataset";
  constexpr unsigned fastest = 1;
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  checked(H5Pset_obj_track_times(properties.id(), false), what);  // the same trials, the same bytes
  if (rows == 0) return properties;                               // nothing to cut into chunks
  const hsize_t chunk = chunk_rows(rows);
  checked(H5Pset_chunk(properties.id(), 1, &chunk), what);
  if (compressed) {
    checked(H5Pset_shuffle(properties.id()), what);
    checked(H5Pset_deflate(properties.id(), fastest), what);
  }
  checked(H5Pset_fletcher32(properties.id()), what);
  return properties;
}

}  // namespace

void write_column(hid_t group, const std::string& name, NumberType type, const void* data, std::size_t rows,
                  const std::string& units) {
  Session::give_way();
  const std::string what = "cannot write the dataset " + name;
  const hsize_t extent = rows;
  const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, what);
  // Whole numbers shrink to a fifth in no time; real ones keep nine tenths of their size for ten times the time.
  const Handle properties = creation_properties(extent, H5Tget_class(type.stored) != H5T_FLOAT);
  const Handle dataset(
      H5Dcreate2(group, name.c_str(), type.stored, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), H5Dclose,
      what);
  if (rows > 0) checked(H5Dwrite(dataset.id(), type.native, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), what);
  write_attribute(dataset.id(), "units", units);
}

Column::Column(hid_t group, const std::string& name, NumberType type, const std::string& units)
    : name_(name),
      native_(type.native),
      dataset_(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "cannot open the dataset " + name) {
  const std::string what = "cannot read the dataset " + name;
  const Handle stored(H5Dget_type(dataset_.id()), H5Tclose, what);
  if (checked(H5Tequal(stored.id(), type.stored), what) == 0) throw Problem(name + " has the wrong type");
  const Handle space(H5Dget_space(dataset_.id()), H5Sclose, what);
  if (checked(H5Sget_simple_extent_ndims(space.id()), what) != 1) throw Problem(name + " is not one-dimensional");
  hsize_t extent = 0;
  checked(H5Sget_simple_extent_dims(space.id(), &extent, nullptr), what);
  rows_ = extent;
  if (const std::string found = read_text_attribute(dataset_.id(), "units"); found != units) {
    throw Problem(name + " is in the units '" + found + "' (it must be '" + units + "')");
  }
}

void Column::read(std::size_t begin, std::size_t count, void* data) const {
  if (count == 0) return;
  Session::give_way();
  const std::string what = "cannot read the dataset " + name_;
  const hsize_t start = begin;
  const hsize_t length = count;
  const Handle stored(H5Dget_space(dataset_.id()), H5Sclose, what);
  checked(H5Sselect_hyperslab(stored.id(), H5S_SELECT_SET, &start, nullptr, &length, nullptr), what);
  const Handle memory(H5Screate_simple(1, &length, nullptr), H5Sclose, what);
  checked(H5Dread(dataset_.id(), native_, memory.id(), stored.id(), H5P_DEFAULT, data), what);
}

}  // namespace steerstat::hdf5
