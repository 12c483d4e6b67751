#include "study/correlation_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "sampling/correlation.hpp"
#include "study/limits.hpp"
#include "study/nearest.hpp"

namespace steerstat {
namespace {

constexpr Range coefficient_range{.low = -1.0, .high = 1.0, .rule = "in (-1, 1)"};
constexpr std::size_t most_shown = 12;  // pairs in one message

using Pair = std::pair<std::size_t, std::size_t>;  // positions in input_definitions(), the smaller first
using Coefficients = std::map<Pair, double>;

std::string_view name_of(std::size_t input) {
  return input_definitions()[input].name;
}

std::string advice_for(std::string_view word) {
  std::vector<std::string_view> known;
  for (const InputDefinition& definition : input_definitions()) {
    if (definition.name.ends_with('.' + std::string(word))) {
      return fmt::format("did you mean \"{}\"?", definition.name);
    }
    known.push_back(definition.name);
  }
  if (const auto near = nearest(word, known)) return fmt::format("did you mean \"{}\"?", *near);
  return "name one as \"plant.m1\"";
}

class CorrelationDecoder {
 public:
  CorrelationDecoder(std::span<const Input> inputs, std::span<const std::string> mistaken)
      : inputs_(inputs), mistaken_(mistaken) {}

  void decode_entry(const Reader& entry, Coefficients& coefficients) const {
    if (!entry.require_array("an array [name, name, correlation]")) return;
    if (entry.value().size() != 3) {
      entry.fail(fmt::format("{} elements ([name, name, correlation] has 3); give two inputs and their correlation",
                             entry.value().size()));
      return;
    }
    const auto first = decode_name(entry.element(0));
    const auto second = decode_name(entry.element(1));
    const auto coefficient = entry.element(2).number_in(coefficient_range, "a correlation");
    if (!first || !second) return;
    if (*first == *second) {
      entry.fail(
          fmt::format("{} with itself (a correlation is between two inputs); name another one", name_of(*first)));
    } else if (!coefficients.emplace(std::minmax(*first, *second), coefficient.value_or(0.0)).second) {
      entry.fail(fmt::format("{} and {} are in the list already (each pair once); remove one of the two",
                             name_of(*first), name_of(*second)));
    }
  }

 private:
  [[nodiscard]] std::optional<std::size_t> decode_name(const Reader& reader) const {
    const auto word = reader.string("an input's name");
    if (!word) return std::nullopt;
    const InputDefinition* definition = find_input(*word);
    if (definition == nullptr) {
      reader.fail(fmt::format("{} is no input (a number of plant, initial_state or controller); {}", quote(*word),
                              advice_for(*word)));
      return std::nullopt;
    }
    if (!require_drawn(reader, *word)) return std::nullopt;
    return static_cast<std::size_t>(definition - input_definitions().data());
  }

  [[nodiscard]] bool require_drawn(const Reader& reader, const std::string& name) const {
    if (std::find(mistaken_.begin(), mistaken_.end(), name) != mistaken_.end()) return true;
    const auto input = std::find_if(inputs_.begin(), inputs_.end(), [&](const Input& i) { return i.name == name; });
    if (std::holds_alternative<Distribution>(input->value)) return true;
    reader.fail(
        fmt::format("{} {} (only what distributions draw is correlated); give it a distribution, or remove "
                    "the correlation",
                    name, std::holds_alternative<Sweep>(input->value) ? "is swept" : "is a fixed number"));
    return false;
  }

  std::span<const Input> inputs_;
  std::span<const std::string> mistaken_;
};

std::vector<PairCorrelation> pairs_of(const Coefficients& coefficients) {
  std::vector<PairCorrelation> pairs;
  for (const auto& [pair, coefficient] : coefficients) pairs.push_back({pair.first, pair.second, coefficient});
  return pairs;
}

// The correlations between inputs that contradict one another.
std::string shown_between(const std::vector<std::size_t>& inputs, const Coefficients& coefficients) {
  std::string text;
  std::size_t count = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    for (std::size_t j = i + 1; j < inputs.size(); ++j) {
      const auto entry = coefficients.find({inputs[i], inputs[j]});
      if (entry == coefficients.end() || ++count > most_shown) continue;
      text +=
          fmt::format("{}{} and {} {}", count > 1 ? ", " : "", name_of(inputs[i]), name_of(inputs[j]), entry->second);
    }
  }
  if (count > most_shown) text += fmt::format(" and {} more", count - most_shown);
  return text;
}

void require_positive_definite(const Reader& reader, const Coefficients& coefficients) {
  const auto pairs = pairs_of(coefficients);
  if (factorise_correlation(input_count, pairs)) return;
  const auto inputs = contradicting_variables(input_count, pairs);
  reader.fail(
      fmt::format("no inputs can be correlated so: {} (the correlations must make a positive definite matrix, in which "
                  "pairs that are not listed are 0); bring them closer to 0, or list the pairs that are missing",
                  shown_between(inputs, coefficients)));
}

}  // namespace

std::vector<Correlation> decode_correlations(const Reader& reader, std::span<const Input> inputs,
                                             std::span<const std::string> mistaken) {
  if (!reader.require_array("an array of [name, name, correlation]")) return {};
  const std::size_t size = reader.value().size();
  if (size > most_correlations) {
    reader.fail(fmt::format("{} correlations (at most {}); list each pair of inputs once", size, most_correlations));
    return {};
  }
  const std::size_t mistakes = reader.errors().size();
  const CorrelationDecoder decoder(inputs, mistaken);
  Coefficients coefficients;
  for (std::size_t i = 0; i < size; ++i) decoder.decode_entry(reader.element(i), coefficients);
  if (reader.errors().size() == mistakes) require_positive_definite(reader, coefficients);
  if (reader.errors().size() != mistakes) return {};
  std::vector<Correlation> correlations;
  for (const auto& [pair, coefficient] : coefficients) {
    if (coefficient == 0.0) continue;
    correlations.push_back({std::string(name_of(pair.first)), std::string(name_of(pair.second)), coefficient});
  }
  return correlations;
}

nlohmann::json encode_correlations(std::span<const Correlation> correlations) {
  auto list = nlohmann::json::array();
  for (const Correlation& correlation : correlations) {
    list.push_back({correlation.first, correlation.second, correlation.coefficient});
  }
  return list;
}

}  // namespace steerstat
