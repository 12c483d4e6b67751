#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/errors.hpp"
#include "store/attribute.hpp"
#include "store/column.hpp"
#include "store/layout.hpp"
#include "store/memory_file.hpp"
#include "store/result_file.hpp"
#include "store/seal.hpp"
#include "store/sketch_columns.hpp"
#include "store/trial_columns.hpp"
#include "store/whole_file.hpp"
#include "study/spec_json.hpp"
#include "study/subset_simulation.hpp"
#include "study/watched.hpp"

namespace steerstat {
namespace {

using hdf5::Problem;

/// Refuses bytes that are not as they were written, before HDF5 sees them.
std::span<const std::byte> intact(std::span<const std::byte> bytes) {
  if (const auto content = without_seal(bytes)) return *content;
  constexpr std::array<unsigned char, 8> hdf5_signature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  const auto signature = std::as_bytes(std::span(hdf5_signature));
  if (bytes.size() < signature.size() || !std::equal(signature.begin(), signature.end(), bytes.begin())) {
    throw Problem("it is not a result file of steerstat");
  }
  throw Problem(
      "it is damaged, cut short or was changed since it was written: its last line is not the SHA-256 of what comes "
      "before");
}

void require_our_format(hid_t file) {
  if (const std::string filetype = hdf5::read_text_attribute(file, "filetype"); filetype != layout::filetype) {
    throw Problem(fmt::format("its filetype is '{}' (it must be '{}')", filetype, layout::filetype));
  }
  const std::uint32_t version = hdf5::read_integer_attribute(file, "format_version");
  if (version != layout::format_version) {
    throw Problem(fmt::format("it is of format {}, and this program reads format {}; use the version that wrote it, {}",
                              version, layout::format_version, hdf5::read_text_attribute(file, "engine_version")));
  }
}

Study read_study(hid_t file) {
  Study study;
  try {
    study = decode_study(hdf5::read_text_attribute(file, "spec"), {});
  } catch (const BadSpec& bad) {
    throw Problem(fmt::format("its spec is not one that this version accepts: {}", bad.what()));
  }
  if (spec_sha256(study) != hdf5::read_text_attribute(file, "spec_sha256")) {
    throw Problem("its spec and its spec_sha256 do not belong together");
  }
  return study;
}

/// Lists the trials that a subset simulation came to: its spec alone has only those of the first level.
void list_trials(hid_t file, Study& study) {
  if (study.sampling.method != SamplingMethod::subset_simulation) return;
  const std::vector<std::string> names = Plan(study).varying();
  const hdf5::Handle trials = hdf5::open_group(file, "trials");
  const hdf5::Handle parameters = hdf5::open_group(file, "parameters");
  const std::size_t rows = hdf5::Column(trials.id(), "index", hdf5::type_of(std::uint64_t{}), "1").rows();
  std::vector<double> values(rows * names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto column = hdf5::read_column<double>(parameters.id(), names[i], layout::units_of(names[i]), rows);
    for (std::size_t row = 0; row < rows; ++row) values[row * names.size() + i] = column[row];
  }
  study.sampling.explicit_names = names;
  study.sampling.explicit_values = std::move(values);
}

/// @throws Problem where the trials are not those that a subset simulation of the study comes to
void check_levels(const Study& study, const TrialTable& trials) {
  if (study.sampling.method != SamplingMethod::subset_simulation) return;
  try {
    subset_levels(study, trials);
  } catch (const std::invalid_argument&) {
    throw Problem("its trials are not those of a finished subset simulation");
  }
}

/// @throws Problem where a trial is said to be in another cell than its own
void check_cells(hid_t trials, const Plan& plan, std::span<const std::uint64_t> index) {
  const auto cells = hdf5::read_column<std::uint64_t>(trials, "cell", "1", index.size());
  for (std::size_t row = 0; row < index.size(); ++row) {
    if (cells[row] != plan.cell_of(index[row])) {
      throw Problem(fmt::format("/trials/cell {} in row {} is not that of its trial", cells[row], row));
    }
  }
}

TrialTable read_trials(hid_t file, const Plan& plan) {
  const hdf5::Handle group = hdf5::open_group(file, "trials");
  TrialTable table;
  table.index = hdf5::read_index(group.id(), plan.trials());
  table.outcomes = hdf5::read_outcomes(group.id(), {0, table.index.size(), table.index.size()});
  check_cells(group.id(), plan, table.index);
  return table;
}

/// @throws Problem where there is the row of a trial that the sketch does not have
void require_sketched(const StudyResult& result) {
  for (const TrialRange& rows : ranges_of(result.trials.index)) {
    const auto& known = result.sketch->trials();
    if (std::any_of(known.begin(), known.end(),
                    [&](TrialRange range) { return range.begin <= rows.begin && rows.end <= range.end; })) {
      continue;
    }
    throw Problem(fmt::format("/trials/index {} is of no trial in its sketch", rows.begin));
  }
}

/// @param trials  those that could be audited
Audit read_audit(hid_t file, const TrialTable& trials) {
  const hdf5::Handle group = hdf5::open_group(file, "audit");
  Audit audit;
  audit.tolerance = hdf5::read_real_attribute(group.id(), "tolerance");
  const std::size_t rows = hdf5::Column(group.id(), "index", hdf5::type_of(std::uint64_t{}), "1").rows();
  if (rows > trials.index.size()) throw Problem(fmt::format("/audit has {} of {} trials", rows, trials.index.size()));
  const auto index = hdf5::read_column<std::uint64_t>(group.id(), "index", "1", rows);
  const auto statuses = hdf5::read_statuses(group.id(), "/audit", {0, rows, rows});
  const auto cycles = hdf5::read_column<std::uint32_t>(group.id(), "cycles", "1", rows);
  const auto swings = hdf5::read_column<std::uint32_t>(group.id(), "swings", "1", rows);
  const auto settling = hdf5::read_column<double>(group.id(), "settling_time", "s", rows);
  if (std::adjacent_find(index.begin(), index.end(), std::greater_equal<>()) != index.end()) {
    throw Problem("/audit/index does not rise");
  }
  for (std::size_t row = 0; row < rows; ++row) {
    if (!std::binary_search(trials.index.begin(), trials.index.end(), index[row])) {
      throw Problem(fmt::format("/audit/index {} is not the index of a trial in the file", index[row]));
    }
    if (std::isfinite(settling[row]) != (statuses[row] == Status::converged)) {
      throw Problem(fmt::format("/audit/settling_time in row {} does not go with its status", row));
    }
    audit.trials.push_back({index[row], statuses[row], cycles[row], swings[row], settling[row]});
  }
  return audit;
}

std::optional<InstructionSet> read_simd(hid_t file) {
  const std::string name = hdf5::read_text_attribute(file, "simd");
  if (name == layout::no_simd) return std::nullopt;
  const std::optional<InstructionSet> set = instruction_set_named(name);
  if (!set) throw Problem(fmt::format("its simd '{}' is no instruction set", name));
  return set;
}

/// @param stored  with the study and its trials
std::optional<StudyShare> read_share(hid_t file, const StoredStudy& stored) {
  if (!hdf5::has_attribute(file, "shard")) return std::nullopt;
  const StudyShare share{hdf5::read_integer_attribute(file, "shard"), hdf5::read_integer_attribute(file, "shards")};
  if (share.number < 1 || share.number > share.count || share.count > most_shares) {
    throw Problem(fmt::format("it calls itself shard {} (shards count from 1)", share_text(share)));
  }
  if (stored.result.complete) throw Problem("it is a shard and called complete");
  const TrialRange range = trials_of(stored.study, share);
  const TrialTable& trials = stored.result.trials;
  const auto ranges = stored.result.sketch ? stored.result.sketch->trials() : ranges_of(trials.index);
  if (!ranges.empty() && (ranges.front().begin < range.begin || ranges.back().end > range.end)) {
    throw Problem(fmt::format("it has trials that are not in shard {}", share_text(share)));
  }
  return share;
}

std::vector<std::vector<double>> read_parameters(hid_t file, const Plan& plan, std::size_t rows) {
  const hdf5::Handle group = hdf5::open_group(file, "parameters");
  std::vector<std::vector<double>> columns;
  for (const std::string& name : plan.varying()) {
    columns.push_back(hdf5::read_column<double>(group.id(), name, layout::units_of(name), rows));
  }
  return columns;
}

StoredStudy read_bytes(std::span<const std::byte> bytes) {
  const hdf5::Session session;
  const hdf5::Handle file = hdf5::open_in_memory(bytes);
  require_our_format(file.id());
  StoredStudy stored;
  stored.study = read_study(file.id());
  list_trials(file.id(), stored.study);
  stored.created = hdf5::read_text_attribute(file.id(), "created");
  stored.engine_version = hdf5::read_text_attribute(file.id(), "engine_version");
  const Plan plan(stored.study);
  stored.result.trials = read_trials(file.id(), plan);
  check_levels(stored.study, stored.result.trials);
  stored.has_metrics = hdf5::has_every_outcome(hdf5::open_group(file.id(), "trials").id());
  stored.parameters = read_parameters(file.id(), plan, stored.result.trials.index.size());
  if (stored.study.store != Store::all) {
    stored.result.sketch = hdf5::read_sketch(file.id(), plan.cells(), plan.trials());
    require_sketched(stored.result);
  }
  stored.result.audit = read_audit(file.id(), stored.result.trials);
  stored.result.complete = hdf5::read_flag_attribute(file.id(), "complete");
  if (stored.result.complete) {
    const std::uint64_t due = trials_due(stored.study, stored.result);
    if (stored.result.finished() != due) {
      throw Problem(fmt::format("it is called complete with {} of {} trials", stored.result.finished(), due));
    }
  }
  stored.result.wall_s = hdf5::read_real_attribute(file.id(), "wall_s");
  stored.result.threads = hdf5::read_integer_attribute(file.id(), "threads");
  stored.result.simd = read_simd(file.id());
  stored.result.share = read_share(file.id(), stored);
  return stored;
}

}  // namespace

StoredStudy read_result(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_whole_file(path);
  try {
    return read_bytes(intact(bytes));
  } catch (const Problem& problem) {
    throw RunFailure(fmt::format("cannot read {}: {}", path.string(), problem.what()));
  }
}

}  // namespace steerstat
