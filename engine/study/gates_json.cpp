#include "study/gates_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "study/gate_expression.hpp"
#include "study/limits.hpp"
#include "study/nearest.hpp"
#include "study/rate.hpp"
#include "study/unmeasured_json.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

constexpr std::string_view example = "QUANTITY COMPARISON NUMBER, such as \"ci_low >= 0.99\"";
constexpr std::array<std::string_view, 2> scope_names{"all", "each_cell"};

std::vector<std::string_view> names_to_judge() {
  std::vector<std::string_view> names(rate_names().begin(), rate_names().end());
  for (const Metric& metric : metrics()) names.push_back(metric.name);
  return names;
}

std::optional<std::string> decode_metric(const Reader& reader, bool measured) {
  const std::vector<std::string_view> names = names_to_judge();
  const auto position = reader.one_of(names);
  if (!position) return std::nullopt;
  if (!measured) refuse_unmeasured(reader, names[*position]);
  return std::string(names[*position]);
}

void refuse_syntax(const Reader& reader, const GateSyntaxError& error, std::span<const std::string_view> quantities) {
  std::string advice;
  if (error.wanted == "a quantity") {
    const auto near = nearest(error.found, quantities);
    advice = near ? fmt::format("; did you mean {}?", *near) : fmt::format("; one of {}", listed(quantities));
  } else if (error.found == "=" || error.found == "==" || error.found == "!=") {
    advice = "; nothing estimated is exactly equal, ask for <= or >=";
  } else if (error.found == "%") {
    advice = "; for 99 % write 0.99";
  }
  reader.fail(fmt::format("expected {} at character {}, found {} ({}){}", error.wanted, error.position,
                          error.found.empty() ? "the end" : quote(error.found), example, advice));
}

/// What a user meant who asked for a quantity that the metric does not have.
std::string_view counterpart(Quantity quantity, bool is_rate) {
  if (is_rate) return "estimate";
  return quantity == Quantity::estimate ? "mean" : "mean or a quantile, which are judged by their intervals";
}

std::optional<GateExpression> decode_expression(const Reader& reader, const std::optional<std::string>& metric) {
  const auto text = reader.string("a string, " + std::string(example));
  if (!text) return std::nullopt;
  const bool is_rate = metric && outcome_of_rate(*metric);
  std::span<const std::string_view> quantities = quantity_names;
  if (metric) quantities = is_rate ? rate_quantities() : sample_quantities();
  const auto parsed = parse_gate_expression(*text);
  if (const auto* error = std::get_if<GateSyntaxError>(&parsed)) {
    refuse_syntax(reader, *error, quantities);
    return std::nullopt;
  }
  const auto& expression = std::get<GateExpression>(parsed);
  const std::string_view quantity = quantity_names[static_cast<std::size_t>(expression.quantity)];
  if (std::find(quantities.begin(), quantities.end(), quantity) == quantities.end()) {
    reader.fail(fmt::format("{} has no {} (of {} there are {}); use {}", *metric, quantity,
                            is_rate ? "a rate" : "a metric of trials", listed(quantities),
                            counterpart(expression.quantity, is_rate)));
    return std::nullopt;
  }
  if (is_rate && expression.quantity != Quantity::count && !(expression.bound >= 0.0 && expression.bound <= 1.0)) {
    reader.fail(fmt::format("{} is out of range (a rate is in [0, 1]); {}", expression.bound,
                            expression.bound > 1.0 && expression.bound <= 100.0
                                ? fmt::format("for {} % write {}", expression.bound, expression.bound / 100.0)
                                : "give a share"));
    return std::nullopt;
  }
  return expression;
}

const Sweep* sweep_of(const Input& input) {
  return std::get_if<Sweep>(&input.value);
}

void decode_swept_value(const Reader& reader, const Input& input, Gate& gate) {
  const auto value = reader.number();
  if (!value) return;
  const std::vector<double>& values = std::get<Sweep>(input.value).values;
  if (std::find(values.begin(), values.end(), *value) == values.end()) {
    const double near = *std::min_element(
        values.begin(), values.end(), [&](double a, double b) { return std::abs(a - *value) < std::abs(b - *value); });
    reader.fail(fmt::format("{} is not swept over {} (a cell has values of the sweeps); the nearest is {}", input.name,
                            *value, near));
    return;
  }
  gate.cell.push_back({input.name, *value});
}

/// In the order of the inputs, so that a gate does not depend on how its cell was written.
void decode_cell(const Reader& reader, const std::vector<Input>& inputs, const std::vector<std::string>& mistaken,
                 Gate& gate) {
  if (!reader.require_object("an object {\"controller.contraction.eta1\": 0.5, ...}")) return;
  if (reader.value().empty()) {
    reader.fail("the cell names nothing (at least one swept input); name one, or leave \"cell\" out");
    return;
  }
  std::vector<std::string_view> swept;
  for (const Input& input : inputs) {
    const bool is_swept = sweep_of(input) != nullptr;
    const bool unsure = std::find(mistaken.begin(), mistaken.end(), input.name) != mistaken.end();
    if (is_swept || unsure) swept.emplace_back(input.name);
    const auto member = reader.find(input.name);
    if (member && is_swept) decode_swept_value(*member, input, gate);
    if (!member || is_swept || unsure) continue;
    member->fail(fmt::format("{} is not swept (a cell is named by swept inputs); sweep it, or remove it", input.name));
    swept.emplace_back(input.name);  // said
  }
  reader.refuse_unknown_keys(swept);
}

Gate decode_gate(const Reader& reader, const std::vector<Input>& inputs, bool measured,
                 const std::vector<std::string>& mistaken) {
  static constexpr std::array<std::string_view, 4> known{"metric", "expr", "scope", "cell"};
  Gate gate;
  if (!reader.require_object("an object {\"metric\", \"expr\"}")) return gate;
  reader.refuse_unknown_keys(known);
  const auto metric = reader.require("metric");
  const auto name = metric ? decode_metric(*metric, measured) : std::nullopt;
  gate.metric = name.value_or(gate.metric);
  const auto expression = reader.require("expr");
  if (expression) gate.expression = decode_expression(*expression, name).value_or(gate.expression);
  const auto scope = reader.find("scope");
  const auto cell = reader.find("cell");
  if (scope && cell) {
    scope->fail("\"scope\" beside \"cell\" (either says what is judged); remove one of them");
  } else if (scope) {
    gate.each_cell = scope->one_of(scope_names) == std::size_t{1};
  } else if (cell) {
    decode_cell(*cell, inputs, mistaken, gate);
  }
  return gate;
}

}  // namespace

std::vector<Gate> decode_gates(const Reader& reader, const std::vector<Input>& inputs, bool measured,
                               const std::vector<std::string>& mistaken) {
  std::vector<Gate> gates;
  if (!reader.require_array("an array of gates [{\"metric\", \"expr\"}, ...]")) return gates;
  const std::size_t size = reader.value().size();
  if (size > most_gates) {
    reader.fail(fmt::format("{} gates (at most {}); remove some", size, most_gates));
    return gates;
  }
  for (std::size_t i = 0; i < size; ++i) gates.push_back(decode_gate(reader.element(i), inputs, measured, mistaken));
  return gates;
}

nlohmann::json encode_gates(const std::vector<Gate>& gates) {
  auto array = nlohmann::json::array();
  for (const Gate& gate : gates) {
    nlohmann::json object = {{"metric", gate.metric}, {"expr", expression_text(gate.expression)}};
    if (gate.each_cell) object["scope"] = scope_names[1];
    for (const Gate::SweptValue& swept : gate.cell) object["cell"][swept.input] = swept.value;
    array.push_back(std::move(object));
  }
  return array;
}

BaselineTest decode_baseline_test(const Reader& reader) {
  static constexpr std::array<std::string_view, 3> known{"level", "power", "margin"};
  constexpr Range below_half{.low = 0.0, .high = 0.5, .rule = "in (0, 0.5)"};
  constexpr Range above_half{.low = 0.5, .high = 1.0, .rule = "in (0.5, 1)"};
  constexpr Range share{.low = 0.0, .high = 1.0, .rule = "in (0, 1)"};
  BaselineTest test;
  if (!reader.require_object("an object {\"level\", \"power\", \"margin\"}")) return test;
  reader.refuse_unknown_keys(known);
  if (const auto level = reader.find("level")) {
    test.level = level->number_in(below_half, "baseline.level").value_or(test.level);
  }
  if (const auto power = reader.find("power")) {
    test.power = power->number_in(above_half, "baseline.power").value_or(test.power);
  }
  if (const auto margin = reader.find("margin")) {
    test.margin = margin->number_in(share, "baseline.margin").value_or(test.margin);
  }
  return test;
}

nlohmann::json encode_baseline_test(const BaselineTest& test) {
  return {{"level", test.level}, {"power", test.power}, {"margin", test.margin}};
}

}  // namespace steerstat
