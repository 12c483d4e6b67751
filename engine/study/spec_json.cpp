#include "study/spec_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/elementary.hpp"
#include "study/gates_json.hpp"
#include "study/input_json.hpp"
#include "study/inputs.hpp"
#include "study/integrator_json.hpp"
#include "study/intervals_json.hpp"
#include "study/limits.hpp"
#include "study/parse_json.hpp"
#include "study/reader_json.hpp"
#include "study/retention_json.hpp"
#include "study/rules.hpp"
#include "study/sampling_json.hpp"
#include "study/stop_json.hpp"
#include "study/store_rules.hpp"

namespace steerstat {
namespace {

std::size_t characters_in(const std::string& utf8) {
  std::size_t count = 0;
  for (const char c : utf8) count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
  return count;
}

// The part of a dotted name up to the next dot after `start`.
std::string_view component(std::string_view name, std::size_t start) {
  return name.substr(start, name.find('.', start) - start);
}

class Decoder {
 public:
  Decoder(const Json& document, const std::filesystem::path& directory, std::vector<SpecError>& errors)
      : root_(document, "", errors), directory_(directory), errors_(errors) {}

  Study decode() {
    if (!root_.require_object("an object: a study spec is {...}")) return study_;
    refuse_unknown_keys();
    if (const auto kind = root_.find("kind")) decode_kind(*kind);
    if (const auto name = root_.find("name")) decode_name(*name);
    const std::size_t before = errors_.size();
    if (const auto nominal = root_.find("nominal")) decode_nominal(*nominal);
    if (errors_.size() != before) mistaken_.emplace_back("nominal");
    study_.inputs = default_inputs(study_.nominal);
    for (const std::string_view group : {"plant", "initial_state", "controller", "actuator", "sensor"}) {
      if (const auto reader = root_.find(group)) decode_group(*reader, std::string(group));
    }
    if (const auto goal = root_.find("goal")) decode_goal(*goal);
    if (const auto horizon = root_.find("horizon")) {
      study_.horizon = decode_fixed(*horizon, positive, "horizon", "write a spec for each").value_or(study_.horizon);
    }
    if (const auto integrator = root_.find("integrator")) decode_integrator(*integrator, study_.integrator);
    if (const auto sampling = root_.find("sampling")) {
      const std::size_t start = errors_.size();
      study_.sampling = decode_sampling(*sampling, directory_, study_.inputs, mistaken_);
      if (errors_.size() != start) mistaken_.emplace_back("sampling");
    }
    if (const auto metrics = root_.find("metrics")) {
      study_.integrator.metrics = metrics->boolean().value_or(study_.integrator.metrics);
    }
    if (const auto stop = root_.find("stop")) decode_stop_rule(*stop);
    if (const auto retain = root_.find("retain")) study_.retention = decode_retention(*retain);
    if (const auto store = root_.find("store")) {
      if (const auto position = store->one_of(store_names)) study_.store = static_cast<Store>(*position);
    }
    if (const auto audit = root_.find("audit")) decode_audit(*audit);
    const bool stops = root_.find("stop").has_value();
    study_.intervals = default_intervals(stops);
    if (const auto intervals = root_.find("intervals")) study_.intervals = decode_intervals(*intervals, stops);
    if (const auto gates = root_.find("gates")) {
      study_.gates = decode_gates(*gates, study_.inputs, study_.integrator.metrics, mistaken_);
    }
    if (const auto baseline = root_.find("baseline")) study_.baseline_test = decode_baseline_test(*baseline);
    check_rules(study_, mistaken_, errors_);
    check_store(study_, mistaken_, errors_);
    return study_;
  }

 private:
  void refuse_unknown_keys() {
    static constexpr std::array<std::string_view, 19> known{
        "name",      "nominal", "plant",      "initial_state", "goal", "controller", "actuator",
        "sensor",    "horizon", "integrator", "sampling",      "stop", "retain",     "audit",
        "intervals", "metrics", "gates",      "baseline",      "store"};
    static constexpr std::array<std::string_view, 1> spoken_for{"kind"};
    root_.refuse_unknown_keys(known, spoken_for);
  }

  static void decode_kind(const Reader& reader) {
    static constexpr std::array<std::string_view, 2> names{"stabilisation", "approximation"};
    const auto position = reader.one_of(names);
    if (!position || *position == 0) return;
    reader.fail("an approximation study (only stabilisation studies are taken here); steerstat run takes both");
  }

  void decode_name(const Reader& reader) {
    const auto name = reader.string("a string");
    if (!name) return;
    const bool has_control = std::any_of(name->begin(), name->end(),
                                         [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
    const std::size_t length = characters_in(*name);
    if (has_control) {
      reader.fail("the name has control characters (printable text); remove them");
    } else if (length < 1 || length > longest_name) {
      reader.fail(fmt::format("the name has {} characters (1 to {})", length, longest_name));
    } else {
      study_.name = *name;
    }
  }

  // A number that no study varies.
  std::optional<double> decode_fixed(const Reader& reader, const Range& range, std::string_view name,
                                     std::string_view advice) {
    if (!reader.value().is_object()) return reader.number_in(range, name);
    reader.fail(fmt::format("{} is a fixed number (no distribution, no sweep); {}", name, advice));
    return std::nullopt;
  }

  void decode_nominal(const Reader& reader) {
    if (!reader.require_object("an object {\"m1\", \"m2\", ...}")) return;
    std::vector<std::string_view> known;
    TrialParameters parameters;
    for (const InputDefinition& definition : input_definitions()) {
      if (!definition.name.starts_with("plant.") || definition.is_imperfection) continue;
      const std::string_view key = definition.name.substr(6);
      known.push_back(key);
      const auto member = reader.find(key);
      if (!member) continue;
      const std::string name = fmt::format("nominal.{}", key);
      const auto value = decode_fixed(*member, definition.range, name, "vary it in plant");
      definition.field(parameters) = value.value_or(definition.field(parameters));
      if (!value) mistaken_.push_back(name);
    }
    reader.refuse_unknown_keys(known);
    study_.nominal = parameters.plant;
  }

  // Everything below `prefix`, which is "plant", "controller", "controller.contraction" and so on.
  void decode_group(const Reader& reader, const std::string& prefix) {
    if (!reader.require_object("an object {...}")) return;
    const std::vector<std::string_view> known = keys_below(prefix);
    reader.refuse_unknown_keys(known);
    for (const std::string_view key : known) {
      const auto member = reader.find(key);
      if (!member) continue;
      const std::string name = fmt::format("{}.{}", prefix, key);
      if (name == "controller.policy") {
        decode_policy(*member);
      } else if (name == "controller.realignment") {
        const auto position = member->one_of(realignment_names);
        if (position) study_.realignment = static_cast<Realignment>(*position);
      } else if (const InputDefinition* definition = find_input(name)) {
        decode_value(*member, *definition);
      } else {
        decode_group(*member, name);
      }
    }
  }

  void decode_policy(const Reader& reader) {
    const auto position = reader.one_of(policy_names);
    if (position) {
      study_.policy = static_cast<Policy>(*position);
    } else {
      mistaken_.emplace_back("controller.policy");
    }
  }

  static std::vector<std::string_view> keys_below(const std::string& prefix) {
    std::vector<std::string_view> keys;
    if (prefix == "controller") keys = {"policy", "realignment"};
    for (const InputDefinition& definition : input_definitions()) {
      if (!definition.name.starts_with(prefix + ".")) continue;
      const std::string_view key = component(definition.name, prefix.size() + 1);
      if (keys.empty() || keys.back() != key) keys.push_back(key);
    }
    return keys;
  }

  void decode_value(const Reader& reader, const InputDefinition& definition) {
    std::optional<double> nominal;
    if (definition.name.starts_with("plant.") && !definition.is_imperfection &&
        !is_mistaken(fmt::format("nominal.{}", definition.name.substr(6)))) {
      TrialParameters parameters;
      parameters.plant = study_.nominal;
      nominal = definition.field(parameters);
    }
    const auto value = decode_input(definition, nominal, reader);
    if (!value) {
      mistaken_.emplace_back(definition.name);
      return;
    }
    for (Input& input : study_.inputs) {
      if (input.name == definition.name) input.value = *value;
    }
  }

  void decode_goal(const Reader& reader) {
    if (!reader.require_object("an object {\"q1\", \"q2\"}")) return;
    static constexpr std::array<std::string_view, 2> known{"q1", "q2"};
    reader.refuse_unknown_keys(known);
    double q1 = study_.goal.q1;
    double q2 = study_.goal.q2;
    if (const auto member = reader.find("q1")) {
      q1 = decode_fixed(*member, any_number, "goal.q1", "vary initial_state.q1").value_or(q1);
    }
    if (const auto member = reader.find("q2")) {
      const auto value = decode_fixed(*member, any_number, "goal.q2", "vary initial_state.q2");
      const auto [s, c] = sincos(value.value_or(q2));
      if (std::abs(2.0 * s * c) < least_goal_sine) {
        member->fail(
            fmt::format("sin 2 q2 is {:.4g} at {} (at least {} in size: near a multiple of pi/2 no contraction "
                        "is possible); choose another angle, such as pi/4 = 0.7853981633974483",
                        2.0 * s * c, *value, least_goal_sine));
      } else {
        q2 = value.value_or(q2);
      }
    }
    study_.goal = goal_at(q1, q2);
  }

  void decode_stop_rule(const Reader& reader) {
    const auto sampling = root_.find("sampling");
    const bool trials_are_given = sampling && sampling->value().is_object() && sampling->find("trials").has_value();
    const std::size_t before = errors_.size();
    // Where the sampling has mistakes, the numbers of trials are not held against its own.
    Sampling unknown;
    unknown.trials = most_trials;
    const bool measured = study_.integrator.metrics;
    study_.stop = is_mistaken("sampling") ? decode_stop(reader, unknown, false, measured)
                                          : decode_stop(reader, study_.sampling, trials_are_given, measured);
    if (errors_.size() != before) mistaken_.emplace_back("stop");
  }

  void decode_audit(const Reader& reader) {
    static constexpr std::array<std::string_view, 1> known{"trials"};
    if (!reader.require_object("an object {\"trials\"}")) return;
    reader.refuse_unknown_keys(known);
    if (const auto trials = reader.find("trials")) {
      study_.audited_trials = trials->integer(0, most_trials).value_or(study_.audited_trials);
    }
  }

  [[nodiscard]] bool is_mistaken(const std::string& name) const {
    return std::find(mistaken_.begin(), mistaken_.end(), name) != mistaken_.end();
  }

  Reader root_;
  const std::filesystem::path& directory_;
  std::vector<SpecError>& errors_;
  std::vector<std::string> mistaken_;
  Study study_;
};

}  // namespace

Study decode_study(std::string_view text, const std::filesystem::path& directory) {
  std::vector<SpecError> errors;
  const Json document = parse_json(text, errors);
  Study study = Decoder(document, directory, errors).decode();
  if (errors.empty()) return study;
  sort_by_place(errors, document);
  if (errors.size() > most_errors) {
    const std::size_t more = errors.size() - most_errors;
    errors.resize(most_errors);
    errors.push_back({"", fmt::format("and {} more mistakes; correct these first", more)});
  }
  throw BadSpec(std::move(errors));
}

}  // namespace steerstat
