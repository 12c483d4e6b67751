#include "study/distribution_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "study/limits.hpp"

namespace steerstat {
namespace {

using Shape = Distribution::Shape;

struct Member {
  std::string_view name;
  Range range;
};

// The numbers of an object with exactly these members, in their order.
template <std::size_t n>
std::optional<std::array<double, n>> members(const Reader& reader, std::string_view wanted,
                                             const std::array<Member, n>& expected) {
  if (!reader.require_object(fmt::format("an object {}", wanted))) return std::nullopt;
  std::array<std::string_view, n> names;
  std::array<double, n> values{};
  bool whole = true;
  for (std::size_t i = 0; i < n; ++i) {
    names[i] = expected[i].name;
    const auto member = reader.require(expected[i].name);
    const auto x = member ? member->number_in(expected[i].range, expected[i].name) : std::nullopt;
    whole = whole && x.has_value();
    values[i] = x.value_or(0.0);
  }
  reader.refuse_unknown_keys(names);
  if (!whole) return std::nullopt;
  return values;
}

bool require_ordered(const Reader& reader, double low, double high) {
  if (low < high && std::isfinite(high - low)) return true;
  if (low > high) {
    reader.fail(fmt::format("low {} is above high {} (low < high); swap them", low, high));
  } else if (low == high) {
    reader.fail(fmt::format("low and high are both {} (low < high); give the number alone", low));
  } else {
    reader.fail(fmt::format("from {} to {} is too wide (high - low must be finite); narrow it", low, high));
  }
  return false;
}

std::optional<Shape> decode_uniform(const Reader& reader) {
  static constexpr std::array<std::string_view, 2> names{"low", "high"};
  const auto x = reader.numbers(names, "[low, high]");
  if (!x || !require_ordered(reader, (*x)[0], (*x)[1])) return std::nullopt;
  return Uniform{(*x)[0], (*x)[1]};
}

std::optional<Shape> decode_triangular(const Reader& reader) {
  static constexpr std::array<std::string_view, 3> names{"low", "mode", "high"};
  const auto x = reader.numbers(names, "[low, mode, high]");
  if (!x || !require_ordered(reader, (*x)[0], (*x)[2])) return std::nullopt;
  const Triangular shape{(*x)[0], (*x)[1], (*x)[2]};
  if (shape.mode >= shape.low && shape.mode <= shape.high) return shape;
  reader.fail(fmt::format("mode {} is outside [{}, {}] (low <= mode <= high); the order is [low, mode, high]",
                          shape.mode, shape.low, shape.high));
  return std::nullopt;
}

std::optional<Shape> decode_normal(const Reader& reader) {
  const auto x = members<2>(reader, "{\"mean\", \"std\"}", {{{"mean", any_number}, {"std", positive}}});
  if (!x) return std::nullopt;
  return Normal{(*x)[0], (*x)[1]};
}

std::optional<Shape> decode_truncated_normal(const Reader& reader) {
  const auto x = members<4>(reader, "{\"mean\", \"std\", \"low\", \"high\"}",
                            {{{"mean", any_number}, {"std", positive}, {"low", any_number}, {"high", any_number}}});
  if (!x) return std::nullopt;
  const auto [mean, std, low, high] = *x;
  if (!require_ordered(reader, low, high)) return std::nullopt;
  if (TruncatedNormal::bounds_hold_probability(mean, std, low, high)) return TruncatedNormal(mean, std, low, high);
  reader.fail(
      fmt::format("[{}, {}] is more than 8 standard deviations from the mean {} (the bounds must hold some of "
                  "the normal); move them towards the mean",
                  low, high, mean));
  return std::nullopt;
}

std::optional<Shape> decode_lognormal(const Reader& reader) {
  const auto x = members<2>(reader, "{\"median\", \"sigma\"}", {{{"median", positive}, {"sigma", positive}}});
  if (!x) return std::nullopt;
  return Lognormal{(*x)[0], (*x)[1]};
}

std::optional<std::vector<double>> list(const Reader& reader, const Range& range, std::string_view name) {
  if (!reader.require_array("an array of numbers")) return std::nullopt;
  const std::size_t size = reader.value().size();
  if (size == 0 || size > most_discrete_values) {
    reader.fail(fmt::format("{} elements (1 to {}); list as many values as weights", size, most_discrete_values));
    return std::nullopt;
  }
  std::vector<double> values;
  values.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    if (const auto x = reader.element(i).number_in(range, name)) values.push_back(*x);
  }
  if (values.size() != size) return std::nullopt;
  return values;
}

bool require_total(const Reader& reader, const std::vector<double>& weights) {
  double total = 0.0;
  for (const double weight : weights) total += weight;
  if (total > 0.0 && std::isfinite(total)) return true;
  reader.fail(fmt::format("the weights' sum is {} (> 0 and finite); {}", total,
                          total > 0.0 ? "scale them down" : "give some value a weight"));
  return false;
}

std::optional<Shape> decode_discrete(const Reader& reader) {
  if (!reader.require_object("an object {\"values\", \"weights\"}")) return std::nullopt;
  static constexpr std::array<std::string_view, 2> names{"values", "weights"};
  reader.refuse_unknown_keys(names);
  const auto values_reader = reader.require("values");
  const auto weights_reader = reader.require("weights");
  auto values = values_reader ? list(*values_reader, any_number, "a value") : std::nullopt;
  auto weights = weights_reader ? list(*weights_reader, non_negative, "a weight") : std::nullopt;
  if (weights && !require_total(*weights_reader, *weights)) return std::nullopt;
  if (!values || !weights) return std::nullopt;
  if (values->size() != weights->size()) {
    reader.fail(fmt::format("{} values but {} weights (one weight a value); make the lists equally long",
                            values->size(), weights->size()));
    return std::nullopt;
  }
  return Discrete(*std::move(values), *std::move(weights));
}

struct Encode {
  nlohmann::json operator()(const Uniform& s) const { return {{"uniform", {s.low, s.high}}}; }
  nlohmann::json operator()(const Normal& s) const { return {{"normal", {{"mean", s.mean}, {"std", s.std}}}}; }
  nlohmann::json operator()(const TruncatedNormal& s) const {
    return {{"truncated_normal",
             {{"mean", s.mean()}, {"std", s.std()}, {"low", s.support().low}, {"high", s.support().high}}}};
  }
  nlohmann::json operator()(const Lognormal& s) const {
    return {{"lognormal", {{"median", s.median}, {"sigma", s.sigma}}}};
  }
  nlohmann::json operator()(const Triangular& s) const { return {{"triangular", {s.low, s.mode, s.high}}}; }
  nlohmann::json operator()(const Discrete& s) const {
    return {{"discrete", {{"values", s.values()}, {"weights", s.weights()}}}};
  }
};

}  // namespace

std::optional<Shape> decode_shape(std::string_view name, const Reader& reader) {
  if (name == "uniform") return decode_uniform(reader);
  if (name == "normal") return decode_normal(reader);
  if (name == "truncated_normal") return decode_truncated_normal(reader);
  if (name == "lognormal") return decode_lognormal(reader);
  if (name == "triangular") return decode_triangular(reader);
  return decode_discrete(reader);
}

nlohmann::json encode_distribution(const Distribution& distribution) {
  nlohmann::json value = std::visit(Encode{}, distribution.shape);
  if (distribution.relative) value["relative"] = true;
  return value;
}

}  // namespace steerstat
