#include "study/approximation_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "study/input_json.hpp"
#include "study/limits.hpp"
#include "study/reader_json.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

constexpr Range tolerance_range{
    .low = 1e-14, .high = 1e-6, .includes_low = true, .includes_high = true, .rule = "in [1e-14, 1e-6]"};

class ApproximationDecoder {
 public:
  ApproximationDecoder(const Json& document, std::vector<SpecError>& errors)
      : root_(document, "", errors), errors_(errors) {}

  ApproximationStudy decode() {
    static constexpr std::array<std::string_view, 6> known{"kind", "name", "plant", "cycle", "integrator", "sampling"};
    if (!root_.require_object("an object: a study spec is {...}")) return study_;
    root_.refuse_unknown_keys(known);
    study_.cycle = {Distribution{Uniform{0.1, 1.4}}, Distribution{Uniform{0.05, 0.5}}, 50.0, 2.0};
    if (const auto name = root_.find("name")) decode_name(*name);
    if (const auto plant = root_.find("plant")) decode_plant(*plant);
    if (const auto cycle = root_.find("cycle")) decode_cycle(*cycle);
    if (const auto integrator = root_.find("integrator")) decode_integrator(*integrator);
    if (const auto sampling = root_.find("sampling")) decode_sampling_of(*sampling);
    if (errors_.empty()) check_size();
    return study_;
  }

 private:
  void decode_name(const Reader& reader) {
    const auto name = reader.string("a string");
    if (!name) return;
    if (name->empty() || name->size() > longest_name) {
      reader.fail(fmt::format("the name has {} bytes (1 to {})", name->size(), longest_name));
    } else {
      study_.name = *name;
    }
  }

  void decode_plant(const Reader& reader) {
    if (!reader.require_object("an object {\"m1\", \"m2\", \"d2\", \"I2\"}")) return;
    // The approximation is of the frictionless robot, so there is no friction to set.
    static constexpr std::array<std::string_view, 4> known{"m1", "m2", "d2", "I2"};
    reader.refuse_unknown_keys(known);
    TrialParameters parameters;
    for (const std::string_view key : known) {
      const auto member = reader.find(key);
      if (!member) continue;
      const InputDefinition& definition = *find_input(fmt::format("plant.{}", key));
      double& field = definition.field(parameters);
      field = member->number_in(definition.range, definition.name).value_or(field);
    }
    study_.plant = parameters.plant;
  }

  void decode_cycle(const Reader& reader) {
    static constexpr std::array<std::string_view, 4> known{"q2", "q2_dot", "amplitude", "period"};
    if (!reader.require_object("an object {\"q2\", \"q2_dot\", \"amplitude\", \"period\"}")) return;
    reader.refuse_unknown_keys(known);
    for (std::size_t i = 0; i < known.size(); ++i) {
      const auto member = reader.find(known[i]);
      auto value = member ? decode_input(cycle_definitions()[i], std::nullopt, *member) : std::nullopt;
      if (value) study_.cycle[i] = *std::move(value);
    }
  }

  void decode_integrator(const Reader& reader) {
    static constexpr std::array<std::string_view, 1> known{"tolerance"};
    if (!reader.require_object("an object {\"tolerance\"}")) return;
    reader.refuse_unknown_keys(known);
    if (const auto tolerance = reader.find("tolerance")) {
      study_.tolerance = tolerance->number_in(tolerance_range, "integrator.tolerance").value_or(study_.tolerance);
    }
  }

  void decode_sampling_of(const Reader& reader) {
    static constexpr std::array<std::string_view, 2> known{"trials", "seed"};
    if (!reader.require_object("an object {\"trials\", \"seed\"}")) return;
    reader.refuse_unknown_keys(known);
    if (const auto trials = reader.find("trials")) {
      study_.draws = trials->integer(1, ApproximationStudy::most_cycles).value_or(study_.draws);
    }
    if (const auto seed = reader.find("seed")) {
      study_.seed = seed->integer(0, std::numeric_limits<std::uint64_t>::max()).value_or(study_.seed);
    }
  }

  void check_size() {
    std::uint64_t cells = 1;  // cannot overflow: a sweep has at most 100,000 values
    for (const InputValue& input : study_.cycle) {
      if (const auto* sweep = std::get_if<Sweep>(&input)) cells *= sweep->values.size();
      if (cells > ApproximationStudy::most_cycles) break;
    }
    if (cells <= ApproximationStudy::most_cycles / study_.draws) return;
    root_.fail(fmt::format("{} trials in {} cells make too many cycles (at most {}); draw or sweep fewer", study_.draws,
                           cells, ApproximationStudy::most_cycles));
  }

  Reader root_;
  std::vector<SpecError>& errors_;
  ApproximationStudy study_;
};

}  // namespace

ApproximationStudy decode_approximation(std::string_view text) {
  std::vector<SpecError> errors;
  const Json document = parse_json(text, errors);
  ApproximationStudy study = ApproximationDecoder(document, errors).decode();
  if (errors.empty()) return study;
  sort_by_place(errors, document);
  if (errors.size() > most_errors) errors.resize(most_errors);
  throw BadSpec(std::move(errors));
}

std::variant<Study, ApproximationStudy> decode_any_study(std::string_view text,
                                                         const std::filesystem::path& directory) {
  std::vector<SpecError> duplicates;  // the decoders report them
  const Json document = parse_json(text, duplicates);
  const auto kind = document.is_object() ? document.find("kind") : document.end();
  if (document.is_object() && kind != document.end() && *kind == "approximation") return decode_approximation(text);
  return decode_study(text, directory);
}

}  // namespace steerstat
