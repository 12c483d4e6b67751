#include "report/text_table.hpp"

#include <gtest/gtest.h>

namespace steerstat {
namespace {

TEST(TextTable, AlignsColumnsUnderTheirHeaders) {
  TextTable table({{"name", TextTable::Align::left}, {"n"}, {"note", TextTable::Align::left}});
  table.add_row({{"a"}, {"1"}, {""}});
  table.add_row({{"longer"}, {"1,000"}, {"x"}});
  EXPECT_EQ(table.text(false),
            "  name        n  note\n"
            "  ───────────────────\n"
            "  a           1\n"
            "  longer  1,000  x\n");
}

TEST(TextTable, CountsLettersNotBytes) {
  TextTable table({{"η", TextTable::Align::left}, {"±"}});
  table.add_row({{"ab"}, {"–"}});
  EXPECT_EQ(table.text(false),
            "  η   ±\n"
            "  ─────\n"
            "  ab  –\n");
}

TEST(TextTable, HasEscapeSequencesOnlyWhenColoursAreAskedForAndTheSameTextThen) {
  TextTable table({{"a"}});
  table.add_row({{"1", fg(fmt::terminal_color::green)}});
  EXPECT_EQ(table.text(false).find('\x1b'), std::string::npos);
  std::string coloured = table.text(true);
  EXPECT_NE(coloured.find("\x1b[32m1\x1b[0m"), std::string::npos);
  while (coloured.find('\x1b') != std::string::npos) {
    const std::size_t begin = coloured.find('\x1b');
    coloured.erase(begin, coloured.find('m', begin) + 1 - begin);
  }
  EXPECT_EQ(coloured, table.text(false));
}

}  // namespace
}  // namespace steerstat
