#pragma once

#include <string>
#include <string_view>

#include "page/embedded_page.hpp"

namespace steerstat {

/// One self-contained HTML file: the page with a report's data inside. It asks nobody for anything: its
/// Content-Security-Policy allows its own script and style, by their SHA-256, and data: pictures, and nothing else.
///
/// @param files     not absent
/// @param title     of the document; any UTF-8
/// @param document  JSON, `report` in schemas/view.schema.json
/// @throws RunFailure for a program without the page; std::logic_error where index.html is not as
///         server/dashboard/README.md says
std::string report_page(const PageFiles& files, std::string_view title, std::string_view document);

/// `sha256-` and the hash in base64, as a Content-Security-Policy names an inline script or style.
std::string content_hash(std::string_view content);

}  // namespace steerstat
