#include "study/sampling_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "study/correlation_json.hpp"
#include "study/explicit_csv.hpp"
#include "study/limits.hpp"
#include "study/proposal_json.hpp"

namespace steerstat {
namespace {

constexpr std::array<std::string_view, 2> base_names{"monte_carlo", "sobol"};  // of sobol_indices

std::optional<SamplingMethod> decode_method(const Reader& reader) {
  const auto member = reader.find("method");
  if (!member) return SamplingMethod::monte_carlo;
  const auto position = member->one_of(sampling_method_names);
  if (!position) return std::nullopt;
  return static_cast<SamplingMethod>(*position);
}

// Puts the columns into the order of input_names(), so that a study does not depend on how its table was written.
void take_table(ExplicitTable table, Sampling& sampling) {
  std::vector<std::size_t> order;
  for (const InputDefinition& definition : input_definitions()) {
    const auto found = std::find(table.names.begin(), table.names.end(), definition.name);
    if (found == table.names.end()) continue;
    order.push_back(static_cast<std::size_t>(found - table.names.begin()));
    sampling.explicit_names.emplace_back(definition.name);
  }
  sampling.trials = table.rows();
  sampling.explicit_values.reserve(table.values.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (const std::size_t column : order) {
      sampling.explicit_values.push_back(table.values[row * table.names.size() + column]);
    }
  }
}

// One object of "trials"; the first one decides what all of them set.
void decode_row(const Reader& row, bool first, ExplicitTable& table) {
  if (!row.require_object("an object {\"plant.m1\": number, ...}")) return;
  std::vector<std::string_view> known;
  for (const InputDefinition& definition : input_definitions()) known.push_back(definition.name);
  row.refuse_unknown_keys(known);
  if (first) {
    for (const std::string_view name : known) {
      if (row.find(name)) table.names.emplace_back(name);
    }
    if (row.value().empty()) row.fail("the trial sets nothing (at least one input); add one, such as \"plant.m1\"");
  }
  for (const std::string_view name : known) {
    const auto value = row.find(name);
    const bool wanted = std::find(table.names.begin(), table.names.end(), name) != table.names.end();
    if (value && !wanted)
      value->fail("the first trial does not set this (all trials set the same inputs); add it there");
    if (!value && wanted) row.fail(fmt::format("\"{}\" is missing (all trials set the same inputs); add it", name));
    const auto x = value ? value->number_in(find_input(name)->range, name) : std::nullopt;
    if (wanted) table.values.push_back(x.value_or(0.0));
  }
}

void decode_rows(const Reader& reader, Sampling& sampling) {
  if (!reader.require_array("an array of trials (method \"explicit\")")) return;
  const std::size_t size = reader.value().size();
  if (size == 0 || size > most_explicit_trials) {
    reader.fail(fmt::format("{} trials (1 to {}); {}", size, most_explicit_trials,
                            size == 0 ? "list at least one" : "split the study"));
    return;
  }
  const std::size_t mistakes = reader.errors().size();
  ExplicitTable table;
  for (std::size_t i = 0; i < size; ++i) decode_row(reader.element(i), i == 0, table);
  if (reader.errors().size() == mistakes) take_table(std::move(table), sampling);
}

void decode_file(const Reader& reader, const std::filesystem::path& directory, Sampling& sampling) {
  const auto name = reader.string("the name of a CSV file");
  if (!name) return;
  if (directory.empty()) {
    reader.fail("files are not read here; list the trials in \"trials\"");
    return;
  }
  if (name->empty() || name->find('\0') != std::string::npos) {
    reader.fail("not a file's name; give the name of a CSV file");
    return;
  }
  std::string problem;
  const std::string text = read_text_file(directory / *name, problem);
  if (!problem.empty()) {
    reader.fail(fmt::format("{} cannot be read: {}; names are relative to the spec", quote(*name), problem));
    return;
  }
  std::vector<std::string> problems;
  ExplicitTable table = parse_explicit_csv(text, problems);
  for (const std::string& line : problems) reader.fail(fmt::format("{}: {}", quote(*name), line));
  if (problems.empty()) take_table(std::move(table), sampling);
}

constexpr std::uint64_t default_states = 1000;  // of a level

std::optional<std::uint64_t> decode_states(const Reader& reader) {
  const auto states = reader.integer(100, most_states);
  if (!states || *states % 10 == 0) return states;
  reader.fail(fmt::format("{} trials a level (a multiple of 10, a tenth of which begin the next level); take {}",
                          *states, (*states + 9) / 10 * 10));
  return std::nullopt;
}

void decode_explicit(const Reader& reader, const std::filesystem::path& directory, Sampling& sampling) {
  const auto rows = reader.find("trials");
  const auto file = reader.find("file");
  if (rows && file) {
    file->fail("\"trials\" and \"file\" (one source of trials); remove one of them");
  } else if (rows) {
    decode_rows(*rows, sampling);
  } else if (file) {
    decode_file(*file, directory, sampling);
  } else {
    reader.fail("no trials (method \"explicit\" lists them); add \"trials\": [{...}, ...] or \"file\": \"x.csv\"");
  }
}

}  // namespace

Sampling decode_sampling(const Reader& reader, const std::filesystem::path& directory, std::span<const Input> inputs,
                         std::span<const std::string> mistaken) {
  Sampling sampling;
  if (!reader.require_object("an object {\"method\", \"trials\", \"seed\"}")) return sampling;
  static constexpr std::array<std::string_view, 8> known{"method",      "trials", "seed",     "file",
                                                         "correlation", "base",   "proposal", "levels"};
  reader.refuse_unknown_keys(known);
  if (const auto seed = reader.find("seed")) {
    sampling.seed = seed->integer(0, std::numeric_limits<std::uint64_t>::max()).value_or(sampling.seed);
  }
  const auto method = decode_method(reader);
  sampling.method = method.value_or(sampling.method);
  if (const auto base = reader.find("base")) {
    if (method && method != SamplingMethod::sobol_indices) {
      base->fail("only the method sobol_indices has a base; remove it, or set the method");
    } else if (const auto position = base->one_of(base_names)) {
      sampling.base = static_cast<SobolIndicesBase>(*position);
    }
  }
  if (const auto correlation = reader.find("correlation")) {
    if (sampling.method == SamplingMethod::sobol_indices) {
      correlation->fail(
          "the method sobol_indices takes variance apart by inputs (they must be independent); remove it, or use "
          "monte_carlo and show --sensitivity, whose first-order indices need no independence");
    } else if (seeks_failures(sampling.method)) {
      correlation->fail(
          fmt::format("the method {} draws its inputs one by one (they must be independent); remove it, "
                      "or use monte_carlo",
                      sampling_method_names[static_cast<std::size_t>(sampling.method)]));
    } else if (draws(sampling.method)) {
      sampling.correlations = decode_correlations(*correlation, inputs, mistaken);
    } else {
      correlation->fail(
          fmt::format("the method {} draws nothing (only what distributions draw is correlated); remove "
                      "it, or use monte_carlo, latin_hypercube or sobol",
                      sampling_method_names[static_cast<std::size_t>(sampling.method)]));
    }
  }
  const auto proposal = reader.find("proposal");
  if (method == SamplingMethod::importance) {
    sampling.proposal = proposal ? decode_proposal(*proposal, inputs, mistaken) : default_proposal(inputs);
  } else if (proposal && method) {
    proposal->fail("only the method importance has a proposal; remove it, or set the method");
  }
  if (const auto levels = reader.find("levels")) {
    if (method && method != SamplingMethod::subset_simulation) {
      levels->fail("only the method subset_simulation has levels; remove it, or set the method");
    } else {
      sampling.levels = levels->integer(1, most_levels).value_or(sampling.levels);
    }
  }
  if (method == SamplingMethod::explicit_trials) {
    decode_explicit(reader, directory, sampling);
    return sampling;
  }
  if (const auto file = reader.find("file"))
    file->fail("only the method explicit reads a file; remove it, or set the method");
  const auto trials = reader.find("trials");
  if (method == SamplingMethod::subset_simulation) {
    sampling.trials = trials ? decode_states(*trials).value_or(default_states) : default_states;
    return sampling;
  }
  if (!trials) return sampling;
  if (method == SamplingMethod::grid) {
    trials->fail("a grid has no trials key (each combination of the sweeps runs once); remove it");
  } else if (trials->value().is_array()) {
    trials->fail("an array of trials (that is the method explicit); add \"method\": \"explicit\"");
  } else {
    sampling.trials = trials->integer(1, most_trials).value_or(sampling.trials);
  }
  return sampling;
}

nlohmann::json encode_sampling(const Sampling& sampling) {
  nlohmann::json object;
  object["method"] = sampling_method_names[static_cast<std::size_t>(sampling.method)];
  object["seed"] = sampling.seed;
  if (draws(sampling.method)) object["trials"] = sampling.trials;
  if (sampling.method == SamplingMethod::sobol_indices) {
    object["base"] = base_names[static_cast<std::size_t>(sampling.base)];
  }
  if (sampling.method == SamplingMethod::subset_simulation) object["levels"] = sampling.levels;
  if (sampling.method == SamplingMethod::importance) object["proposal"] = encode_proposal(sampling.proposal);
  if (!sampling.correlations.empty()) object["correlation"] = encode_correlations(sampling.correlations);
  if (sampling.method != SamplingMethod::explicit_trials) return object;
  auto rows = nlohmann::json::array();
  const std::size_t columns = sampling.explicit_names.size();
  for (std::size_t row = 0; row < sampling.trials; ++row) {
    auto trial = nlohmann::json::object();
    for (std::size_t i = 0; i < columns; ++i) {
      trial[sampling.explicit_names[i]] = sampling.explicit_values[row * columns + i];
    }
    rows.push_back(std::move(trial));
  }
  object["trials"] = std::move(rows);
  return object;
}

}  // namespace steerstat
