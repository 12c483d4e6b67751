#pragma once

#include <string>
#include <string_view>

namespace steerstat {

/// The page's files (server/dashboard/README.md): all of it, in three pieces.
struct PageFiles {
  std::string_view html;    ///< index.html, which refers to the others once each
  std::string_view style;   ///< page.css
  std::string_view script;  ///< page.js
  /// Why the program was built without the page, a clause; then the files are empty. "" where it has it.
  std::string_view absence;
};

/// The page that this program was built with. Thread-safe; the views hold for as long as the program runs.
PageFiles embedded_page();

/// What to tell somebody who asks for the page of a program without one: problem, reason, and what to do.
std::string missing_page(const PageFiles& files);

}  // namespace steerstat
