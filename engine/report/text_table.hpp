#pragma once

#include <fmt/color.h>

#include <cstddef>
#include <string>
#include <vector>

namespace steerstat {

/// Columns on a terminal that a text takes, counting every code point as one.
std::size_t display_width(const std::string& utf8);

inline const fmt::text_style bold = fmt::emphasis::bold;
inline const fmt::text_style faint = fmt::emphasis::faint;

/// `text` in `style` where `colour` is asked for.
std::string styled(const std::string& text, const fmt::text_style& style, bool colour);

/// A table for a terminal: a header, a rule, rows; columns as wide as their widest cell, two spaces apart.
class TextTable {
 public:
  enum class Align { left, right };

  struct Column {
    std::string header;
    Align align{Align::right};
  };

  struct Cell {
    std::string text;
    fmt::text_style style{};
  };

  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// @param cells  (columns)
  void add_row(std::vector<Cell> cells) { rows_.push_back(std::move(cells)); }

  /// The table's lines, each indented by two spaces and ended by a newline, without spaces at their ends.
  [[nodiscard]] std::string text(bool colour) const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;  // (rows x columns)
};

}  // namespace steerstat
