#include "study/explicit_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "study/inputs.hpp"
#include "study/limits.hpp"
#include "study/nearest.hpp"

namespace steerstat {
namespace {

constexpr std::size_t most_problems = 20;
constexpr std::uintmax_t largest_file = std::uintmax_t{256} << 20U;  // [bytes]

std::string_view trimmed(std::string_view field) {
  static constexpr std::string_view space = " \t\r";
  const std::size_t first = field.find_first_not_of(space);
  if (first == std::string_view::npos) return {};
  field = field.substr(first, field.find_last_not_of(space) - first + 1);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
  return field;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

// A field as a message shows it; bytes that are not printable ASCII become "?".
std::string shown_field(std::string_view field) {
  std::string shown(field.substr(0, 40));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

std::optional<double> number_in(std::string_view field) {
  if (field.size() > 1 && field.front() == '+' && field[1] != '-') field.remove_prefix(1);
  double value = 0.0;
  const char* const end = field.data() + field.size();
  const auto [stop, failure] = std::from_chars(field.data(), end, value);
  if (failure != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value + 0.0;  // -0 becomes 0
}

class CsvReader {
 public:
  explicit CsvReader(std::vector<std::string>& problems) : problems_(problems) {}

  void read_header(std::string_view text) {
    std::vector<std::string_view> known;
    for (const InputDefinition& definition : input_definitions()) known.push_back(definition.name);
    for (const std::string_view name : fields_of(text)) {
      if (find_input(name) == nullptr) {
        const auto near = nearest(name, known);
        complain(fmt::format("unknown column \"{}\" (columns are called like plant.m1); {}", shown_field(name),
                             near ? fmt::format("did you mean \"{}\"?", *near) : "remove or rename it"));
      } else if (std::find(table.names.begin(), table.names.end(), name) != table.names.end()) {
        complain(fmt::format("the column {} appears twice (once each); remove one", name));
      }
      table.names.emplace_back(name);
    }
  }

  void read_row(std::string_view text) {
    const auto fields = fields_of(text);
    if (fields.size() != table.names.size()) {
      complain(fmt::format("{} fields (the header has {}); every line needs a number for each column", fields.size(),
                           table.names.size()));
      return;
    }
    for (std::size_t i = 0; i < fields.size(); ++i) read_field(table.names[i], fields[i]);
  }

  void complain(const std::string& problem) {
    ++count_;
    if (count_ <= most_problems) problems_.push_back(fmt::format("line {}: {}", line, problem));
  }

  void finish() {
    if (count_ > most_problems) problems_.push_back(fmt::format("and {} more mistakes", count_ - most_problems));
  }

  ExplicitTable table;
  std::size_t line{0};

 private:
  void read_field(const std::string& name, std::string_view field) {
    const auto value = number_in(field);
    const InputDefinition* definition = find_input(name);
    if (!value) {
      complain(fmt::format("column {}: \"{}\" is not a finite number; correct it", name, shown_field(field)));
    } else if (definition != nullptr && !definition->range.contains(*value)) {
      complain(fmt::format("column {}: {} is out of range ({} {}); give a number {}", name, *value, name,
                           definition->range.rule, definition->range.rule));
    }
    table.values.push_back(value.value_or(0.0));
  }

  std::vector<std::string>& problems_;
  std::size_t count_{0};
};

}  // namespace

ExplicitTable parse_explicit_csv(std::string_view text, std::vector<std::string>& problems) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  CsvReader reader(problems);
  while (!text.empty()) {
    ++reader.line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (trimmed(line).empty()) continue;
    if (reader.table.names.empty()) {
      reader.read_header(line);
    } else if (reader.table.rows() == most_explicit_trials) {
      reader.complain(fmt::format("too many trials (at most {}); split the file", most_explicit_trials));
      break;
    } else {
      reader.read_row(line);
    }
  }
  reader.finish();
  if (reader.table.names.empty()) {
    problems.emplace_back("the file is empty (a header of names, then one line a trial); write both");
  } else if (reader.table.values.empty() && problems.empty()) {
    problems.emplace_back("the file has a header but no trials (one line a trial); add some");
  }
  return std::move(reader.table);
}

std::string read_text_file(const std::filesystem::path& path, std::string& problem) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) {
    problem = "there is no such file";
  } else if (!std::filesystem::is_regular_file(status)) {
    problem = "it is not a regular file";
  } else if (std::filesystem::file_size(path, failure) > largest_file) {
    problem = failure ? failure.message() : fmt::format("it is larger than {} bytes", largest_file);
  }
  if (!problem.empty()) return {};
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || (file.peek() != std::ifstream::traits_type::eof() && !(text << file.rdbuf()))) {
    problem = std::generic_category().message(errno);
    return {};
  }
  return std::move(text).str();
}

}  // namespace steerstat
