#include "text_input.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "core/errors.hpp"

namespace steerstat {
namespace {

// Far above any text that a person or a script means to write; keeps an endless stream from filling the memory.
constexpr std::size_t largest_text = std::size_t{64} << 20;

struct CloseFile {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }  // it was read from
};

std::string reason_of(int error) {
  return std::generic_category().message(error);
}

std::string read_all(std::FILE* file, const std::string& source, std::string_view what, std::string_view advice) {
  std::string text;
  char buffer[1 << 16];
  for (;;) {
    const std::size_t count = std::fread(buffer, 1, sizeof buffer, file);
    text.append(buffer, count);
    if (text.size() > largest_text) {
      throw BadUsage(fmt::format("{} is larger than {} may be ({} MiB); {}", source, what, largest_text >> 20, advice));
    }
    if (count < sizeof buffer) break;
  }
  if (std::ferror(file) != 0) throw BadUsage(fmt::format("cannot read {} ({})", source, reason_of(errno)));
  return text;
}

}  // namespace

std::string read_text(const std::string& name, std::string_view what, std::string_view advice) {
  if (name == "-") return read_all(stdin, "standard input", what, advice);
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(name.c_str(), "rb"));
  if (!file) throw BadUsage(fmt::format("cannot read {} ({}); check the path", name, reason_of(errno)));
  return read_all(file.get(), name, what, advice);
}

}  // namespace steerstat
