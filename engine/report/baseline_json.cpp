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
void read_counts(const Reader& root, Baseline& baseline) {
  const std::size_t mistakes = root.errors().size();
  const auto outcomes = require_object(root, "outcomes");
  if (!outcomes) return;
  baseline.converged = {count_at(*outcomes, name_of(Status::converged)), 0};
  for (const std::string_view outcome : status_names) {
    const std::uint64_t count = count_at(*outcomes, outcome);
    if (count > most - baseline.converged.trials) return outcomes->fail("the counts add up to too much");
    baseline.converged.trials += count;
  }
  if (baseline.converged.trials > 0 || root.errors().size() != mistakes) return;
  outcomes->fail("no trial has finished (a baseline has trials); run the study again");
}

}  // namespace

Baseline read_baseline(std::string_view summary_json) {
  std::vector<SpecError> errors;
  const Json document = parse_json(summary_json, errors);
  const Reader root(document, "", errors);
  Baseline baseline;
  if (root.require_object("an object: a summary is {...}")) {
    read_study_keys(root, baseline);
    read_counts(root, baseline);
    const auto complete = root.require("complete");
    if (complete && complete->boolean() == false) {
      complete->fail("the study was interrupted (a baseline is complete); run it again");
    }
    const auto cells = root.find("cells");
    if (cells && cells->require_array("an array") && !cells->value().empty()) {
      cells->fail("a study with sweeps (a baseline has one success rate); take one without");
    }
  }
  if (!errors.empty()) throw BadSpec(std::move(errors));
  return baseline;
}

}  // namespace steerstat
