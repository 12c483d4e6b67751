#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.hpp"
#include "study/inputs.hpp"
#include "study/parse_json.hpp"

namespace steerstat {

/// One place of a spec: a JSON value, the pointer to it, and the list that mistakes found there go to.
///
/// The getters check: each returns the value, or notes a mistake and returns nothing. Cheap to copy; borrows the
/// document and the list. Not thread-safe.
class Reader {
 public:
  Reader(const Json& value, std::string pointer, std::vector<SpecError>& errors)
      : value_(&value), pointer_(std::move(pointer)), errors_(&errors) {}

  [[nodiscard]] const Json& value() const { return *value_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] std::vector<SpecError>& errors() const { return *errors_; }

  /// Notes a mistake here. @param detail  `problem (rule); suggestion`
  void fail(std::string detail) const;

  /// Whether this is an object; notes a mistake otherwise. @param wanted  what it should be, "an object {...}"
  [[nodiscard]] bool require_object(std::string_view wanted) const;

  /// Whether this is an array; notes a mistake otherwise. @param wanted  as above
  [[nodiscard]] bool require_array(std::string_view wanted) const;

  /// The member called `key` of this object, if it has one.
  [[nodiscard]] std::optional<Reader> find(std::string_view key) const;

  /// The member called `key` of this object; notes a mistake where there is none.
  [[nodiscard]] std::optional<Reader> require(std::string_view key) const;

  /// Element `index` of this array.
  [[nodiscard]] Reader element(std::size_t index) const;

  /// Notes a mistake for every key of this object that is not in `known`, with the one most likely meant; where
  /// there are more than a spec's report holds, for the first ones and for all together.
  /// @param spoken_for  keys that somebody else deals with
  void refuse_unknown_keys(std::span<const std::string_view> known,
                           std::span<const std::string_view> spoken_for = {}) const;

  /// Notes that this key is unknown, with the one of `known` most likely meant, or where else in a spec it belongs.
  void refuse_unknown_key(std::string_view key, std::span<const std::string_view> known) const;

  /// A finite number; -0 is read as 0.
  [[nodiscard]] std::optional<double> number() const;

  /// A number in `range`. @param name  what a message calls it
  [[nodiscard]] std::optional<double> number_in(const Range& range, std::string_view name) const;

  /// The numbers of an array whose elements are called `names`. @param wanted  "[low, high]"
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::span<const std::string_view> names,
                                                           std::string_view wanted) const;

  /// An integer in [low, high]; 1000.0 and 1e3 are integers too (as in JSON Schema).
  [[nodiscard]] std::optional<std::uint64_t> integer(std::uint64_t low, std::uint64_t high) const;

  [[nodiscard]] std::optional<std::string> string(std::string_view wanted) const;
  [[nodiscard]] std::optional<bool> boolean() const;

  /// The position in `names` of the word that stands here.
  [[nodiscard]] std::optional<std::size_t> one_of(std::span<const std::string_view> names) const;

 private:
  void refuse_type(std::string_view wanted) const;

  const Json* value_;
  std::string pointer_;
  std::vector<SpecError>* errors_;
};

/// A JSON value as a message shows it: `0.5`, `"text"`, `an array`.
std::string shown(const Json& value);

/// Words as a message lists them: "a, b and c".
std::string listed(std::span<const std::string_view> words);

}  // namespace steerstat
