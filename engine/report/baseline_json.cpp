#include <fmt/format.h>

#include <limits>

#include "report/baseline.hpp"
#include "study/reader_json.hpp"

namespace steerstat {
namespace {

constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();

std::optional<Reader> require_object(const Reader& reader, std::string_view key) {
  auto member = reader.require(key);
  if (!member || !member->require_object("an object")) return std::nullopt;
  return member;
}

std::string text_at(const Reader& reader, std::string_view key) {
  const auto member = reader.require(key);
  return member ? member->string("a string").value_or("") : "";
}

std::uint64_t count_at(const Reader& reader, std::string_view key) {
  const auto member = reader.require(key);
  return member ? member->integer(0, most).value_or(0) : 0;
}

void read_study_keys(const Reader& root, Baseline& baseline) {
  const auto study = require_object(root, "study");
  if (!study) return;
  baseline.id = text_at(*study, "id");
  baseline.name = text_at(*study, "name");
  baseline.engine_version = text_at(*study, "engine_version");
  baseline.seed = count_at(*study, "seed");
  baseline.population_sha256 = text_at(*study, "population_sha256");
}

/// The trials are those that the outcomes count: of a sensitivity design the independent ones alone.
ProportionCount read_counts(const Reader& parent) {
  const std::size_t mistakes = parent.errors().size();
  const auto outcomes = require_object(parent, "outcomes");
  if (!outcomes) return {};
  ProportionCount converged{count_at(*outcomes, name_of(Status::converged)), 0};
  for (const std::string_view outcome : status_names) {
    const std::uint64_t count = count_at(*outcomes, outcome);
    if (count > most - converged.trials) {
      outcomes->fail("the counts add up to too much");
      return {};
    }
    converged.trials += count;
  }
  if (converged.trials == 0 && parent.errors().size() == mistakes) {
    outcomes->fail("no trial has finished (a baseline has trials); run the study again");
  }
  return converged;
}

Baseline::Cell read_cell(const Reader& reader) {
  Baseline::Cell cell;
  if (!reader.require_object("an object {\"sweep\", \"outcomes\", ...}")) return cell;
  if (const auto sweep = require_object(reader, "sweep")) {
    for (const auto& [name, value] : sweep->value().items()) {
      if (const auto number = sweep->find(name)->number()) cell.sweep.push_back({name, *number});
    }
  }
  cell.converged = read_counts(reader);
  return cell;
}

void read_cells(const Reader& root, Baseline& baseline) {
  const auto cells = root.find("cells");
  if (!cells || !cells->require_array("an array")) return;
  for (std::size_t i = 0; i < cells->value().size(); ++i) baseline.cells.push_back(read_cell(cells->element(i)));
}

/// Summaries of old do not say what their intervals count.
void refuse_sequence(const Reader& root) {
  const auto rate = root.find("success_rate");
  const auto unit = rate && rate->value().is_object() ? rate->find("unit") : std::nullopt;
  if (!unit || unit->value() != "none") return;
  unit->fail(
      "one scrambling of Sobol's sequence (a baseline is of trials that tell an interval); take one by "
      "monte_carlo or latin_hypercube");
}

}  // namespace

Baseline read_baseline(std::string_view summary_json) {
  std::vector<SpecError> errors;
  const Json document = parse_json(summary_json, errors);
  const Reader root(document, "", errors);
  Baseline baseline;
  if (root.require_object("an object: a summary is {...}")) {
    read_study_keys(root, baseline);
    baseline.converged = read_counts(root);
    const auto complete = root.require("complete");
    if (complete && complete->boolean() == false) {
      complete->fail("the study was interrupted (a baseline is complete); run it again");
    }
    read_cells(root, baseline);
    refuse_sequence(root);
  }
  if (!errors.empty()) throw BadSpec(std::move(errors));
  return baseline;
}

}  // namespace steerstat
