#include "page/embedded_page.hpp"

#include <fmt/format.h>

#include <cstddef>

// The files as they are, by the assembler: as C++ arrays they would take the compiler seconds.
#define STEERSTAT_EMBED(symbol, file)            \
  asm(".pushsection .rodata\n"                   \
      ".global steerstat_page_" symbol           \
      "\n"                                       \
      "steerstat_page_" symbol                   \
      ":\n"                                      \
      ".incbin \"" STEERSTAT_PAGE_FILES "/" file \
      "\"\n"                                     \
      ".global steerstat_page_" symbol           \
      "_end\n"                                   \
      "steerstat_page_" symbol                   \
      "_end:\n"                                  \
      ".byte 0\n"                                \
      ".popsection\n")

STEERSTAT_EMBED("html", "index.html");
STEERSTAT_EMBED("style", "page.css");
STEERSTAT_EMBED("script", "page.js");
STEERSTAT_EMBED("absence", "absence.txt");

extern "C" {
extern const char steerstat_page_html[], steerstat_page_html_end[];
extern const char steerstat_page_style[], steerstat_page_style_end[];
extern const char steerstat_page_script[], steerstat_page_script_end[];
extern const char steerstat_page_absence[], steerstat_page_absence_end[];
}

namespace steerstat {
namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

PageFiles embedded_page() {
  return {between(steerstat_page_html, steerstat_page_html_end),
          between(steerstat_page_style, steerstat_page_style_end),
          between(steerstat_page_script, steerstat_page_script_end),
          between(steerstat_page_absence, steerstat_page_absence_end)};
}

std::string missing_page(const PageFiles& files) {
  return fmt::format(
      "this program was built without the page ({}); install Node 18 or later with npm (Debian: apt install npm), "
      "configure with -DSTEERSTAT_PAGE=ON and build again",
      files.absence);
}

}  // namespace steerstat
