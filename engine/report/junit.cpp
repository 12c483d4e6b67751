#include "report/junit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/verdict.hpp"

namespace steerstat {
namespace {

const char* const replacement = "\xEF\xBF\xBD";  // U+FFFD

/// Length in bytes of the well-formed UTF-8 character that `text` begins with, and what it encodes; length 0 for none
/// [Unicode 15, table 3-7].
struct Character {
  std::size_t length;
  char32_t code;
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {1, lead};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return {0, 0};
  char32_t code = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {0, 0};
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return overlong || surrogate || code > 0x10FFFF ? Character{0, 0} : Character{length, code};
}

/// Whether XML 1.0 lets a document have the character [XML 1.0, production 2].
bool is_xml(char32_t code) {
  return code == '\t' || code == '\n' || code == '\r' || (code >= 0x20 && code != 0xFFFE && code != 0xFFFF);
}

/// Text as it stands in an attribute or an element.
std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto [length, code] = first_character(text);
    if (length == 0 || !is_xml(code)) {
      result += replacement;
    } else if (code < 0x20 || std::string_view("&<>\"'").find(text.front()) != std::string_view::npos) {
      // Of a line's end and the like, too: else an attribute would read it as a space.
      result += fmt::format("&#{};", static_cast<unsigned>(code));
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::string test_case(const Summary& summary, const GateVerdict& gate) {
  std::string xml = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\"", escaped(summary.name),
                                escaped(gate_title(gate)));
  if (gate.verdict == Verdict::pass) return xml + "/>\n";
  const char* element = gate.verdict == Verdict::fail ? "failure" : "error";
  xml += fmt::format(">\n      <{} type=\"{}\" message=\"{}\"/>\n    </testcase>\n", element, name_of(gate.verdict),
                     escaped(gate.reason));
  return xml;
}

}  // namespace

std::string junit_xml(const Summary& summary) {
  const auto count = [&](Verdict verdict) {
    return std::count_if(summary.gates.begin(), summary.gates.end(),
                         [&](const GateVerdict& gate) { return gate.verdict == verdict; });
  };
  const std::string counts = fmt::format(
      "name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"0\" time=\"{:.3f}\"", escaped(summary.name),
      summary.gates.size(), count(Verdict::fail), count(Verdict::inconclusive), summary.wall_s);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  xml += fmt::format("<testsuites {}>\n  <testsuite {}>\n    <properties>\n", counts, counts);
  const auto property = [&](const char* name, const std::string& value) {
    xml += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, escaped(value));
  };
  property("id", summary.id);
  property("spec_sha256", summary.spec_sha256);
  property("engine_version", summary.engine_version);
  property("seed", fmt::format("{}", summary.seed));
  property("trials", fmt::format("{} of {}", summary.completed, summary.requested));
  xml += "    </properties>\n";
  for (const GateVerdict& gate : summary.gates) xml += test_case(summary, gate);
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace steerstat
