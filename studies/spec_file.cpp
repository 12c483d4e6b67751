#include "spec_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "core/errors.hpp"
#include "study/approximation_json.hpp"
#include "study/spec_json.hpp"
#include "text_input.hpp"

namespace steerstat {
namespace {

/// Decodes with decode(text, directory). @throws BadUsage with every mistake, one a line
template <class Decode>
auto decode_file(const std::string& name, const Decode& decode) {
  const std::string text = read_text(name, "a spec", "put the trials of an explicit design in a CSV file instead");
  const std::filesystem::path parent =
      name == "-" ? std::filesystem::path() : std::filesystem::path(name).parent_path();
  try {
    return decode(text, parent.empty() ? "." : parent);
  } catch (const BadSpec& bad) {
    const std::size_t count = bad.errors().size();
    std::string message = fmt::format("{} is not a valid study: {} mistake{}, nothing was run",
                                      name == "-" ? "standard input" : name, count, count == 1 ? "" : "s");
    for (const SpecError& error : bad.errors()) {
      message += '\n';
      if (!error.pointer.empty()) message += error.pointer + ": ";
      message += error.detail;
    }
    throw BadUsage(message);
  }
}

}  // namespace

Study read_study(const std::string& name) {
  return decode_file(name, decode_study);
}

std::variant<Study, ApproximationStudy> read_any_study(const std::string& name) {
  return decode_file(name, decode_any_study);
}

}  // namespace steerstat
