#include "page/report_page.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <stdexcept>

#include "core/errors.hpp"

namespace steerstat {
namespace {

/// Puts `replacement` in the place of `mark`, which stands in `html` once.
void replace_once(std::string& html, std::string_view mark, std::string_view replacement) {
  const std::size_t place = html.find(mark);
  if (place == std::string::npos || html.find(mark, place + 1) != std::string::npos) {
    throw std::logic_error(fmt::format("the page's index.html must have {} once", mark));
  }
  html.replace(place, mark.size(), replacement);
}

/// JSON in which nothing ends or opens a tag: `<` stands in strings alone, where an escape means the same.
std::string safe_in_html(std::string_view json) {
  std::string safe;
  safe.reserve(json.size() + json.size() / 64);
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace

std::string content_hash(std::string_view content) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(content.data(), content.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw RunFailure("OpenSSL does not compute SHA-256");
  }
  std::array<unsigned char, std::size_t{2} * EVP_MAX_MD_SIZE> base64{};
  const int length = EVP_EncodeBlock(base64.data(), digest.data(), static_cast<int>(size));
  return "sha256-" + std::string(base64.begin(), base64.begin() + length);
}

std::string report_page(const PageFiles& files, std::string_view title, std::string_view document) {
  if (!files.absence.empty()) throw RunFailure(missing_page(files));
  const std::string policy = fmt::format(
      "default-src 'none'; script-src '{}'; style-src '{}'; img-src data:; base-uri 'none'; form-action 'none'",
      content_hash(files.script), content_hash(files.style));
  std::string html(files.html);
  // The policy first of all, before anything that it is about.
  replace_once(html, R"(<meta charset="utf-8">)",
               fmt::format(R"(<meta charset="utf-8">
    <meta http-equiv="Content-Security-Policy" content="{}">)",
                           policy));
  replace_once(html, "<title>steerstat</title>", fmt::format("<title>{} · steerstat</title>", escaped(title)));
  replace_once(html, R"(<link rel="stylesheet" href="page.css">)", fmt::format("<style>{}</style>", files.style));
  replace_once(html, R"(<script src="page.js"></script>)",
               fmt::format("<script type=\"application/json\" id=\"steerstat-report\">{}</script>\n"
                           "    <script>{}</script>",
                           safe_in_html(document), files.script));
  return html;
}

}  // namespace steerstat
