#include "study/reader_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/limits.hpp"
#include "study/nearest.hpp"

namespace steerstat {
namespace {

// Where the spec's keys stand, dotted: what an unknown key is looked up in when it is not near a sibling.
std::vector<std::string_view> places_in_spec() {
  std::vector<std::string_view> places{"goal.q1",
                                       "goal.q2",
                                       "horizon",
                                       "integrator.method",
                                       "integrator.tolerance",
                                       "sampling.method",
                                       "sampling.trials",
                                       "sampling.seed",
                                       "sampling.file",
                                       "sampling.correlation",
                                       "sampling.base",
                                       "controller.policy",
                                       "controller.realignment",
                                       "retain.trajectories",
                                       "intervals.method",
                                       "intervals.level",
                                       "stop.until",
                                       "stop.check_every",
                                       "stop.min_trials",
                                       "stop.max_trials",
                                       "baseline.level",
                                       "baseline.power",
                                       "baseline.margin"};
  for (const InputDefinition& definition : input_definitions()) places.push_back(definition.name);
  return places;
}

std::optional<std::string_view> place_called(std::string_view key) {
  for (const std::string_view place : places_in_spec()) {
    if (place == key ||
        (place.size() > key.size() && place.ends_with(key) && place[place.size() - key.size() - 1] == '.')) {
      return place;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string shown(const Json& value) {
  switch (value.type()) {
    case Json::value_t::null:
      return "null";
    case Json::value_t::boolean:
      return value.get<bool>() ? "true" : "false";
    case Json::value_t::number_integer:
      return fmt::format("{}", value.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return fmt::format("{}", value.get<std::uint64_t>());
    case Json::value_t::number_float:
      return fmt::format("{}", value.get<double>());
    case Json::value_t::string:
      return quote(value.get_ref<const std::string&>());
    case Json::value_t::array:
      return "an array";
    default:
      return "an object";
  }
}

std::string listed(std::span<const std::string_view> words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 < words.size() ? ", " : " and ";
    text += words[i];
  }
  return text;
}

void Reader::fail(std::string detail) const {
  errors_->push_back({pointer_, std::move(detail)});
}

void Reader::refuse_type(std::string_view wanted) const {
  std::string advice;
  if (value_->is_null()) {
    advice = "; leave the key out for its default";
  } else if (value_->is_string() && wanted.find("number") != std::string_view::npos) {
    advice = "; numbers stand without quotes";
  }
  fail(fmt::format("{} is not {}{}", shown(*value_), wanted, advice));
}

bool Reader::require_object(std::string_view wanted) const {
  if (!value_->is_object()) refuse_type(wanted);
  return value_->is_object();
}

bool Reader::require_array(std::string_view wanted) const {
  if (!value_->is_array()) refuse_type(wanted);
  return value_->is_array();
}

std::optional<Reader> Reader::find(std::string_view key) const {
  for (const auto& member : value_->get_ref<const Json::object_t&>()) {
    if (member.first == key) return Reader(member.second, pointer_ + '/' + pointer_token(key), *errors_);
  }
  return std::nullopt;
}

std::optional<Reader> Reader::require(std::string_view key) const {
  auto member = find(key);
  if (!member) fail(fmt::format("\"{}\" is missing; add it", key));
  return member;
}

Reader Reader::element(std::size_t index) const {
  return {(*value_)[index], pointer_ + '/' + std::to_string(index), *errors_};
}

void Reader::refuse_unknown_keys(std::span<const std::string_view> known,
                                 std::span<const std::string_view> spoken_for) const {
  const auto has = [](std::span<const std::string_view> words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  std::size_t unknown = 0;
  for (const auto& member : value_->get_ref<const Json::object_t&>()) {
    if (!has(known, member.first) && !has(spoken_for, member.first) && ++unknown <= most_errors) {
      Reader(member.second, pointer_ + '/' + pointer_token(member.first), *errors_)
          .refuse_unknown_key(member.first, known);
    }
  }
  if (unknown > most_errors) fail(fmt::format("{} unknown keys; correct the first ones", unknown));
}

void Reader::refuse_unknown_key(std::string_view key, std::span<const std::string_view> known) const {
  std::string advice = "remove it";
  if (const auto near = nearest(key, known)) {
    advice = fmt::format("did you mean \"{}\"?", *near);
  } else if (const auto place = place_called(key)) {
    advice = fmt::format("it belongs at {}", *place);
  }
  static constexpr std::size_t most_listed = 12;
  const std::string rule = known.size() <= most_listed ? fmt::format(" (known here: {})", listed(known)) : "";
  fail(fmt::format("unknown key {}{}; {}", quote(key), rule, advice));
}

std::optional<double> Reader::number() const {
  if (!value_->is_number()) {
    refuse_type("a number");
    return std::nullopt;
  }
  return value_->get<double>() + 0.0;  // -0 becomes 0, which canonical JSON writes and reads alike
}

std::optional<double> Reader::number_in(const Range& range, std::string_view name) const {
  const auto x = number();
  if (!x || range.contains(*x)) return x;
  fail(fmt::format("{} is out of range ({} {}); give a number {}", *x, name, range.rule, range.rule));
  return std::nullopt;
}

std::optional<std::vector<double>> Reader::numbers(std::span<const std::string_view> names,
                                                   std::string_view wanted) const {
  if (!require_array(fmt::format("an array {}", wanted))) return std::nullopt;
  if (value_->size() != names.size()) {
    fail(fmt::format("{} elements ({} has {}); give {}", value_->size(), wanted, names.size(), listed(names)));
    return std::nullopt;
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const auto x = element(i).number()) values.push_back(*x);
  }
  if (values.size() != names.size()) return std::nullopt;
  return values;
}

std::optional<std::uint64_t> Reader::integer(std::uint64_t low, std::uint64_t high) const {
  const auto refuse = [&](std::string_view problem) -> std::optional<std::uint64_t> {
    fail(fmt::format("{} {} (an integer from {} to {})", shown(*value_), problem, low, high));
    return std::nullopt;
  };
  if (value_->is_number_float()) {
    const double x = value_->get<double>();
    if (x != std::floor(x)) return refuse("is not an integer");
    // Beyond 2^53 a double no longer says which integer was meant.
    if (!(x >= static_cast<double>(low) && x <= std::min(static_cast<double>(high), 0x1p53))) {
      return refuse("is out of range");
    }
    return static_cast<std::uint64_t>(x);
  }
  if (!value_->is_number_integer()) return refuse("is not an integer");
  if (!value_->is_number_unsigned() && value_->get<std::int64_t>() < 0) return refuse("is out of range");
  const auto n = value_->get<std::uint64_t>();
  if (n < low || n > high) return refuse("is out of range");
  return n;
}

std::optional<std::string> Reader::string(std::string_view wanted) const {
  if (!value_->is_string()) {
    refuse_type(wanted);
    return std::nullopt;
  }
  return value_->get<std::string>();
}

std::optional<bool> Reader::boolean() const {
  if (!value_->is_boolean()) {
    refuse_type("true or false");
    return std::nullopt;
  }
  return value_->get<bool>();
}

std::optional<std::size_t> Reader::one_of(std::span<const std::string_view> names) const {
  if (!value_->is_string()) {
    refuse_type(fmt::format("one of {}", listed(names)));
    return std::nullopt;
  }
  const auto& word = value_->get_ref<const std::string&>();
  const auto found = std::find(names.begin(), names.end(), word);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const auto near = nearest(word, names);
  fail(fmt::format("{} is unknown (one of {}){}", quote(word), listed(names),
                   near ? fmt::format("; did you mean \"{}\"?", *near) : ""));
  return std::nullopt;
}

}  // namespace steerstat
