#include "study/parse_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace steerstat {
namespace {

void replace(std::string& text, std::string_view old, std::string_view by) {
  if (const std::size_t at = text.find(old); at != std::string::npos) text.replace(at, old.size(), by);
}

// What nlohmann::json reports, without its prefix, position and the token it stopped in (which may hold any bytes):
// "[json.exception...] ... column 5: syntax error <this>; last read: '...'; <and this>".
std::string reason_of(std::string what) {
  const std::size_t column = what.find("column ");
  const std::size_t colon = column == std::string::npos ? std::string::npos : what.find(": ", column);
  if (colon != std::string::npos) what.erase(0, colon + 2);
  if (const std::size_t token = what.find("; last read: "); token != std::string::npos) {
    const std::size_t expected = what.rfind("; expected ");
    const bool follows = expected != std::string::npos && expected > token;
    what.erase(token, follows ? expected - token : std::string::npos);
  }
  replace(what, "syntax error ", "");
  replace(what, "; expected '}'", "; expected ',' or '}'");  // a missing comma is the likelier slip
  replace(what, "; expected ']'", "; expected ',' or ']'");
  return what;
}

// Whether the word at byte `position` (counted from 1) looks like somebody's NaN or infinity.
bool is_non_finite_word(std::string_view text, std::size_t position) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  std::size_t start = std::min(position == 0 ? 0 : position - 1, text.size());
  while (start > 0 && is_letter(text[start - 1])) --start;
  const std::string_view word = text.substr(start, 3);
  return word == "NaN" || word == "nan" || word == "NAN" || word == "inf" || word == "Inf" || word == "INF";
}

// "line 3, column 7" of the character that ends at byte `position` (counted from 1).
std::string place_of(std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, std::min(position == 0 ? 0 : position - 1, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t newline = before.rfind('\n');
  const std::string_view row = newline == std::string_view::npos ? before : before.substr(newline + 1);
  const auto is_start = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  return fmt::format("line {}, column {}", line, 1 + std::count_if(row.begin(), row.end(), is_start));
}

// Builds the document, and watches what nlohmann's own builder does not: repeated keys and nesting.
class DocumentBuilder : public nlohmann::json_sax<Json> {
 public:
  DocumentBuilder(std::string_view text, std::vector<SpecError>& duplicates) : text_(text), duplicates_(duplicates) {}

  [[nodiscard]] Json& document() { return document_; }
  [[nodiscard]] const std::optional<SpecError>& failure() const { return failure_; }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }  // not in JSON text

  bool start_object(std::size_t /*elements*/) override { return open(Json::object()); }
  bool start_array(std::size_t /*elements*/) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    Container& container = open_.back();
    container.key = value;
    if (!container.keys.insert(std::move(value)).second) {
      duplicates_.push_back({pointer(), fmt::format("the key {} appears twice in one object (keys are unique); "
                                                    "remove one of them",
                                                    quote(container.key))});
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string& last_token,
                   const nlohmann::detail::exception& error) override {
    const std::string place = place_of(text_, position);
    const std::string what = error.what();
    if (what.find("out_of_range.406") != std::string::npos) {
      failure_ = {pointer(), fmt::format("the number {} at {} is not a finite double (numbers are at most about "
                                         "1.8e308 in size); give a smaller one",
                                         last_token, place)};
      return false;
    }
    std::string detail = fmt::format("malformed JSON at {}: {}", place, reason_of(what));
    if (is_non_finite_word(text_, position)) detail += "; JSON has no NaN or infinity, give a finite number";
    failure_ = {"", detail};
    return false;
  }

 private:
  struct Container {
    Json* value;
    std::string key{};
    std::unordered_set<std::string> keys{};
  };

  // Of the value that comes next.
  [[nodiscard]] std::string pointer() const {
    std::string path;
    for (const Container& container : open_) {
      path += '/';
      if (container.value->is_object()) {
        path += pointer_token(container.key);
      } else {  // an array that encloses another container has that one as its last element
        path += std::to_string(container.value->size() - (&container == &open_.back() ? 0 : 1));
      }
    }
    return path;
  }

  template <class Value>
  Json* put(Value&& value) {
    if (open_.empty()) {
      document_ = std::forward<Value>(value);
      return &document_;
    }
    Container& container = open_.back();
    if (container.value->is_array()) {
      container.value->push_back(std::forward<Value>(value));
      return &container.value->back();
    }
    // Not emplace(), which searches all keys before: a wide object would take quadratic time.
    auto& members = container.value->get_ref<Json::object_t&>();
    members.push_back({container.key, Json(std::forward<Value>(value))});
    return &members.back().second;
  }

  template <class Value>
  bool add(Value&& value) {
    put(std::forward<Value>(value));
    return true;
  }

  bool open(Json empty) {
    if (open_.size() == deepest_nesting) {
      failure_ = {pointer(), fmt::format("nested too deep (at most {} levels); a spec needs about 6", deepest_nesting)};
      return false;
    }
    open_.push_back({put(std::move(empty))});
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  std::vector<SpecError>& duplicates_;
  Json document_;
  std::vector<Container> open_;  // from the document inwards; only the innermost one grows, so the pointers hold
  std::optional<SpecError> failure_;
};

// Finds where in a document a pointer points. Remembers the keys of every object it passes: a wide object with many
// mistakes would take quadratic time.
class Places {
 public:
  explicit Places(const Json& document) : document_(document) {}

  // The path as positions among siblings; a place that does not exist comes after those that do.
  std::vector<std::size_t> place_of(std::string_view pointer) {
    std::vector<std::size_t> place;
    const Json* value = &document_;
    while (!pointer.empty() && value != nullptr && value->is_structured()) {
      const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
      const std::string token(pointer.substr(1, end - 1));
      pointer.remove_prefix(end);
      place.push_back(value->is_array() ? std::stoul(token) : position_of(token, *value));
      value = place.back() < value->size() ? child(*value, place.back()) : nullptr;
    }
    return place;
  }

 private:
  static const Json* child(const Json& value, std::size_t position) {
    return value.is_array() ? &value[position]
                            : &std::next(value.cbegin(), static_cast<std::ptrdiff_t>(position)).value();
  }

  std::size_t position_of(const std::string& token, const Json& object) {
    auto [known, is_new] = keys_.try_emplace(&object);
    auto& positions = known->second;
    if (is_new) {
      std::size_t position = 0;
      for (const auto& member : object.get_ref<const Json::object_t&>()) {
        positions.emplace(pointer_token(member.first), position++);
      }
    }
    const auto found = positions.find(token);
    return found == positions.end() ? object.size() : found->second;
  }

  const Json& document_;
  std::unordered_map<const Json*, std::unordered_map<std::string, std::size_t>> keys_;
};

}  // namespace

Json parse_json(std::string_view text, std::vector<SpecError>& duplicates) {
  // nlohmann::json would take it for the end of the text and not see what follows.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    throw BadSpec(
        {{"", fmt::format("malformed JSON at {}: a NUL byte; save the file as UTF-8 text", place_of(text, nul + 1))}});
  }
  DocumentBuilder builder(text, duplicates);
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) {
    throw BadSpec({builder.failure().value_or(SpecError{"", "malformed JSON"})});
  }
  return std::move(builder.document());
}

void sort_by_place(std::vector<SpecError>& errors, const Json& document) {
  std::vector<std::pair<std::vector<std::size_t>, SpecError>> placed;
  placed.reserve(errors.size());
  Places places(document);
  for (SpecError& error : errors) {
    auto place = places.place_of(error.pointer);
    placed.emplace_back(std::move(place), std::move(error));
  }
  std::stable_sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::transform(placed.begin(), placed.end(), errors.begin(), [](auto& entry) { return std::move(entry.second); });
}

std::string pointer_token(std::string_view key) {
  std::string token;
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

std::string quote(std::string_view text) {
  static constexpr std::size_t longest = 60;
  std::size_t end = std::min(text.size(), longest);
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  std::string shown(text.substr(0, end));
  if (end < text.size()) shown += "...";
  return Json(shown).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace steerstat
