#pragma once

#include <span>
#include <string>
#include <vector>

#include "store/hdf5.hpp"

/// One-dimensional datasets, row by row, and their `units`. Before each, others may use HDF5 (Session::give_way()): who
/// reads or writes a large file holds nobody up for longer than one of its datasets takes.
namespace steerstat::hdf5 {

/// Writes a dataset (rows) of any type: chunked, a Fletcher-32 checksum on every chunk, whole numbers compressed.
///
/// @param rows  at `type` in memory, `stored` in the file
void write_column(hid_t group, const std::string& name, NumberType type, const void* data, std::size_t rows,
                  const std::string& units);

template <class Number>
void write_column(hid_t group, const std::string& name, std::span<const Number> values, const std::string& units) {
  write_column(group, name, type_of(Number{}), values.data(), values.size(), units);
}

/// Writes what `value_of(row)` gives as a dataset.
template <class Number, class ValueOf>
void write_each(hid_t group, const std::string& name, std::size_t rows, const std::string& units,
                const ValueOf& value_of) {
  std::vector<Number> values(rows);
  for (std::size_t row = 0; row < rows; ++row) values[row] = value_of(row);
  write_column<Number>(group, name, values, units);
}

/// Writes the bytes that `value_of(row)` gives as an enumeration of `names`.
template <class ValueOf>
void write_names(hid_t group, const std::string& name, std::span<const std::string_view> names, std::size_t rows,
                 const ValueOf& value_of) {
  std::vector<std::uint8_t> values(rows);
  for (std::size_t row = 0; row < rows; ++row) values[row] = static_cast<std::uint8_t>(value_of(row));
  const Handle type = enumeration(names);
  write_column(group, name, {type.id(), type.id()}, values.data(), rows, "1");
}

/// A dataset that was found to be what it should be: one-dimensional, of the type and the units asked for.
class Column {
 public:
  /// @throws Problem naming what is wrong
  Column(hid_t group, const std::string& name, NumberType type, const std::string& units);

  [[nodiscard]] std::size_t rows() const { return rows_; }

  /// @param data  (rows) @throws Problem, for one where a checksum is wrong
  void read(void* data) const { read(0, rows_, data); }

  /// Reads the rows [begin, begin + count), which there are. @param data  (count) @throws Problem
  void read(std::size_t begin, std::size_t count, void* data) const;

 private:
  std::string name_;
  hid_t native_;
  Handle dataset_;
  std::size_t rows_{0};
};

/// Rows [begin, begin + count) of datasets that have `of` rows.
struct Rows {
  std::size_t begin;
  std::size_t count;
  std::size_t of;
};

/// A dataset that must have `rows` rows. @throws Problem
template <class Number>
Column column_of(hid_t group, const std::string& name, const std::string& units, std::size_t rows) {
  Column column(group, name, type_of(Number{}), units);
  if (column.rows() != rows) {
    throw Problem(name + " has " + std::to_string(column.rows()) + " rows, /trials/index " + std::to_string(rows));
  }
  return column;
}

/// Reads rows of a dataset that must have as many in all. @throws Problem
template <class Number>
std::vector<Number> read_column(hid_t group, const std::string& name, const std::string& units, Rows rows) {
  const Column column = column_of<Number>(group, name, units, rows.of);
  std::vector<Number> values(rows.count);
  column.read(rows.begin, rows.count, values.data());
  return values;
}

/// Reads a dataset that must have `rows` rows. @throws Problem
template <class Number>
std::vector<Number> read_column(hid_t group, const std::string& name, const std::string& units, std::size_t rows) {
  return read_column<Number>(group, name, units, Rows{0, rows, rows});
}

}  // namespace steerstat::hdf5
