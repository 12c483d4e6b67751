#include "spec_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "core/errors.hpp"
#include "study/approximation_json.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

// Far above any spec that a person or a script means to write; keeps an endless stream from filling the memory.
constexpr std::size_t largest_spec = std::size_t{64} << 20;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string reason(int error) {
  return std::generic_category().message(error);
}

std::string read_all(std::FILE* file, const std::string& source) {
  std::string text;
  char buffer[1 << 16];
  for (;;) {
    const std::size_t count = std::fread(buffer, 1, sizeof buffer, file);
    text.append(buffer, count);
    if (text.size() > largest_spec) {
      throw BadUsage(fmt::format(
          "{} is larger than a spec may be ({} MiB); put the trials of an explicit design in a CSV file instead",
          source, largest_spec >> 20));
    }
    if (count < sizeof buffer) break;
  }
  if (std::ferror(file) != 0) throw BadUsage(fmt::format("cannot read {} ({})", source, reason(errno)));
  return text;
}

std::string read_spec(const std::string& name) {
  if (name == "-") return read_all(stdin, "standard input");
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(name.c_str(), "rb"));
  if (!file) throw BadUsage(fmt::format("cannot read {} ({}); check the spec's path", name, reason(errno)));
  return read_all(file.get(), name);
}

/// Decodes with decode(text, directory). @throws BadUsage with every mistake, one a line
template <class Decode>
auto decode_file(const std::string& name, const Decode& decode) {
  const std::string text = read_spec(name);
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
