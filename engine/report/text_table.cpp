#include "report/text_table.hpp"

#include <algorithm>

namespace steerstat {
namespace {

constexpr std::size_t gap = 2;

std::string repeated(const char* symbol, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += symbol;
  return text;
}

}  // namespace

std::size_t display_width(const std::string& utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string styled(const std::string& text, const fmt::text_style& style, bool colour) {
  return colour ? fmt::format(style, "{}", text) : text;
}

std::string TextTable::text(bool colour) const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::size_t width = display_width(columns_[i].header);
    for (const auto& row : rows_) width = std::max(width, display_width(row[i].text));
    widths.push_back(width);
  }
  std::string result;
  const auto append_line = [&](const auto& cell_of_column) {
    // Spaces are written before the next visible text only, so that no line ends in them.
    std::size_t pending = gap;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const Cell cell = cell_of_column(i);
      const std::size_t padding = widths[i] - display_width(cell.text);
      if (columns_[i].align == Align::right) pending += padding;
      if (!cell.text.empty()) {
        result += std::string(pending, ' ') + styled(cell.text, cell.style, colour);
        pending = 0;
      }
      if (columns_[i].align == Align::left) pending += padding;
      pending += gap;
    }
    result += '\n';
  };
  append_line([&](std::size_t i) { return Cell{columns_[i].header, fmt::emphasis::bold}; });
  std::size_t total = 0;
  for (const std::size_t width : widths) total += width + gap;
  result += std::string(gap, ' ') + styled(repeated("─", total - gap), fmt::emphasis::faint, colour) + '\n';
  for (const auto& row : rows_) append_line([&](std::size_t i) { return row[i]; });
  return result;
}

}  // namespace steerstat
