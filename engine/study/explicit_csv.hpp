#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace steerstat {

/// A table of explicit trials.
struct ExplicitTable {
  std::vector<std::string> names;  ///< of the inputs that the columns set
  std::vector<double> values;      ///< (rows x names), row by row

  [[nodiscard]] std::size_t rows() const { return names.empty() ? 0 : values.size() / names.size(); }
};

/// Reads comma-separated values: a header of inputs' dotted names, then a line of numbers for each trial. Empty lines,
/// spaces around fields, quotes around a whole field, CRLF and a byte order mark are allowed.
///
/// @param problems  gets what is wrong, with line numbers, each as `problem (rule); suggestion`
/// @return the table; worth nothing where there are problems
ExplicitTable parse_explicit_csv(std::string_view text, std::vector<std::string>& problems);

/// Reads a text file whole.
/// @param problem  gets why it could not be read; empty otherwise
std::string read_text_file(const std::filesystem::path& path, std::string& problem);

}  // namespace steerstat
