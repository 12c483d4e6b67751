#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "study/gates_json.hpp"
#include "study/input_json.hpp"
#include "study/inputs.hpp"
#include "study/intervals_json.hpp"
#include "study/sampling_json.hpp"
#include "study/spec_json.hpp"
#include "study/stop_json.hpp"

namespace steerstat {
namespace {

using Canonical = nlohmann::json;  // whose objects are sorted by key

void write(const Canonical& value, std::string& text);

// The shortest decimal that reads back to the same bits; nlohmann's own is not always the shortest.
void write_number(double x, std::string& text) {
  std::array<char, 32> digits{};
  const auto [end, failure] = std::to_chars(digits.data(), digits.data() + digits.size(), x);
  text.append(digits.data(), end);
}

void write_object(const Canonical& value, std::string& text) {
  text += '{';
  char separator = 0;
  for (const auto& [key, member] : value.items()) {
    if (separator != 0) text += separator;
    separator = ',';
    text += Canonical(key).dump();
    text += ':';
    write(member, text);
  }
  text += '}';
}

void write_array(const Canonical& value, std::string& text) {
  text += '[';
  char separator = 0;
  for (const Canonical& element : value) {
    if (separator != 0) text += separator;
    separator = ',';
    write(element, text);
  }
  text += ']';
}

void write(const Canonical& value, std::string& text) {
  if (value.is_object()) {
    write_object(value, text);
  } else if (value.is_array()) {
    write_array(value, text);
  } else if (value.is_number_float()) {
    write_number(value.get<double>(), text);
  } else {
    text += value.dump();
  }
}

Canonical encode_nominal(const PlantParameters<double>& p) {
  return {{"m1", p.m1}, {"m2", p.m2}, {"d2", p.d2}, {"I2", p.I2}, {"f1", p.f1}, {"f2", p.f2}};
}

bool is_off(const Input& input) {
  const auto* number = std::get_if<double>(&input.value);
  return number != nullptr && *number == find_input(input.name)->default_value();
}

bool is_imperfection(const Input& input) {
  return find_input(input.name)->is_imperfection;
}

// A study without imperfections mentions none, so that it is the same study to an engine that knows of none; in another
// they are all filled in, but for a limit that is no number. What the other policy alone reads is never mentioned.
bool is_mentioned(const Input& input, Policy policy, bool has_imperfections) {
  const auto* number = std::get_if<double>(&input.value);
  if (number != nullptr && !std::isfinite(*number)) return false;
  if (is_imperfection(input)) return has_imperfections;
  return find_input(input.name)->policy.value_or(policy) == policy;
}

// Puts an input's value where its dotted name says.
void place(const Input& input, Canonical& spec) {
  Canonical* object = &spec;
  std::string_view name = input.name;
  for (std::size_t dot = name.find('.'); dot != std::string_view::npos; dot = name.find('.')) {
    object = &(*object)[std::string(name.substr(0, dot))];
    name.remove_prefix(dot + 1);
  }
  (*object)[std::string(name)] = encode_input(input.value);
}

Canonical encode_study(const Study& study) {
  Canonical spec = Canonical::object();
  spec["name"] = study.name;
  spec["nominal"] = encode_nominal(study.nominal);
  const bool has_imperfections = std::any_of(study.inputs.begin(), study.inputs.end(), [](const Input& input) {
    return is_imperfection(input) && !is_off(input);
  });
  for (const Input& input : study.inputs) {
    if (is_mentioned(input, study.policy, has_imperfections)) place(input, spec);
  }
  if (study.policy == Policy::paper) {
    spec["controller"]["realignment"] = realignment_names[static_cast<std::size_t>(study.realignment)];
  } else {
    spec["controller"]["policy"] = name_of(study.policy);
  }
  spec["goal"] = {{"q1", study.goal.q1}, {"q2", study.goal.q2}};
  spec["horizon"] = study.horizon;
  spec["integrator"]["method"] = IntegratorChoice::method_names[static_cast<std::size_t>(study.integrator.method)];
  spec["integrator"]["tolerance"] = study.integrator.tolerance;
  spec["sampling"] = encode_sampling(study.sampling);
  spec["retain"]["trajectories"] = {{"failed", study.retention.failed}, {"first", study.retention.first}};
  spec["audit"]["trials"] = study.audited_trials;
  // What a study did not say before these keys existed is left out, so that its identity stays.
  if (Canonical intervals = encode_intervals(study.intervals, study.stop.has_value()); !intervals.is_null()) {
    spec["intervals"] = std::move(intervals);
  }
  if (study.stop) spec["stop"] = encode_stop(*study.stop);
  if (!study.integrator.metrics) spec["metrics"] = false;
  if (study.store != Store::all) spec["store"] = store_names[static_cast<std::size_t>(study.store)];
  if (!study.gates.empty()) spec["gates"] = encode_gates(study.gates);
  if (study.baseline_test != BaselineTest{}) spec["baseline"] = encode_baseline_test(study.baseline_test);
  return spec;
}

}  // namespace

std::string canonical_spec(const Study& study) {
  std::string text;
  write(encode_study(study), text);
  return text;
}

std::string canonical_population(const Study& study) {
  Canonical spec = encode_study(study);
  const Canonical convergence = spec["controller"]["convergence"];
  for (const char* key : {"name", "controller", "integrator", "retain", "audit", "stop", "intervals", "metrics",
                          "gates", "baseline", "store"}) {
    spec.erase(key);
  }
  spec["controller"]["convergence"] = convergence;  // what counts as success
  Canonical& sampling = spec["sampling"];
  sampling.erase("seed");
  if (study.sampling.method != SamplingMethod::explicit_trials) {
    sampling.erase("method");
    sampling.erase("trials");
  }
  std::string text;
  write(spec, text);
  return text;
}

}  // namespace steerstat
