#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "core/errors.hpp"
#include "core/version.hpp"
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

namespace steerstat {
namespace {

void write_description(hid_t file, const Study& study, const StudyResult& result) {
  hdf5::write_attribute(file, "filetype", std::string(layout::filetype));
  hdf5::write_attribute(file, "format_version", layout::format_version);
  hdf5::write_attribute(file, "engine_version", std::string(engine_version()));
  hdf5::write_attribute(file, "created", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))));
  hdf5::write_attribute(file, "spec", canonical_spec(study));
  hdf5::write_attribute(file, "spec_sha256", spec_sha256(study));
  hdf5::write_attribute(file, "complete", result.complete);
  hdf5::write_attribute(file, "wall_s", result.wall_s);
  hdf5::write_attribute(file, "threads", std::uint32_t{result.threads});
  hdf5::write_attribute(file, "simd", std::string(result.simd ? name_of(*result.simd) : layout::no_simd));
  if (result.share) {
    hdf5::write_attribute(file, "shard", result.share->number);
    hdf5::write_attribute(file, "shards", result.share->count);
  }
}

void write_trials(hid_t file, const Study& study, const Plan& plan, const TrialTable& trials) {
  const hdf5::Handle group = hdf5::create_group(file, "trials");
  const std::size_t rows = trials.index.size();
  hdf5::write_column<std::uint64_t>(group.id(), "index", trials.index, "1");
  hdf5::write_each<std::uint64_t>(group.id(), "cell", rows, "1",
                                  [&](std::size_t row) { return plan.cell_of(trials.index[row]); });
  if (study.sampling.method == SamplingMethod::importance) {
    hdf5::write_each<double>(group.id(), "weight", rows, "1",
                             [&](std::size_t row) { return plan.weight(trials.index[row]); });
  }
  if (study.sampling.method == SamplingMethod::subset_simulation && rows > 0) {
    const SubsetLevels levels = subset_levels(study, trials);
    hdf5::write_each<std::uint32_t>(group.id(), "level", rows, "1",
                                    [&](std::size_t row) { return static_cast<std::uint32_t>(levels.level_of(row)); });
  }
  hdf5::write_outcomes(group.id(), trials.outcomes);
}

/// (varying x rows)
std::vector<std::vector<double>> drawn(const Plan& plan, const TrialTable& trials) {
  const std::size_t rows = trials.index.size();
  std::vector<std::vector<double>> columns(plan.varying().size(), std::vector<double>(rows));
  std::vector<double> values(columns.size());
  for (std::size_t row = 0; row < rows; ++row) {
    plan.draw(trials.index[row], values);
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i][row] = values[i];
  }
  return columns;
}

/// @param columns  (varying x rows)
void write_parameters(hid_t file, const Plan& plan, const std::vector<std::vector<double>>& columns) {
  const hdf5::Handle group = hdf5::create_group(file, "parameters");
  const std::vector<std::string>& names = plan.varying();
  for (std::size_t i = 0; i < names.size(); ++i) {
    hdf5::write_column<double>(group.id(), names[i], columns[i], layout::units_of(names[i]));
  }
}

void write_trajectory(hid_t parent, std::uint64_t index, const std::vector<TrajectorySample>& samples) {
  const hdf5::Handle group = hdf5::create_group(parent, std::to_string(index));
  const auto write = [&](const char* name, const char* units, const auto& value_of) {
    hdf5::write_each<double>(group.id(), name, samples.size(), units,
                             [&](std::size_t row) { return value_of(samples[row]); });
  };
  write("t", "s", [](const TrajectorySample& s) { return s.t; });
  write("q1", "m", [](const TrajectorySample& s) { return s.state.q1; });
  write("q2", "rad", [](const TrajectorySample& s) { return s.state.q2; });
  write("q1_dot", "m/s", [](const TrajectorySample& s) { return s.state.q1_dot; });
  write("q2_dot", "rad/s", [](const TrajectorySample& s) { return s.state.q2_dot; });
  write("a", "m/s^2", [](const TrajectorySample& s) { return s.a; });
  write("tau", "N", [](const TrajectorySample& s) { return s.tau; });
  hdf5::write_names(group.id(), "phase", phase_names, samples.size(),
                    [&](std::size_t row) { return samples[row].phase; });
}

void write_audit(hid_t file, const Audit& audit) {
  const hdf5::Handle group = hdf5::create_group(file, "audit");
  hdf5::write_attribute(group.id(), "tolerance", audit.tolerance);
  const std::vector<AuditedTrial>& trials = audit.trials;
  const std::size_t rows = trials.size();
  hdf5::write_each<std::uint64_t>(group.id(), "index", rows, "1", [&](std::size_t row) { return trials[row].index; });
  hdf5::write_names(group.id(), "status", status_names, rows, [&](std::size_t row) { return trials[row].status; });
  hdf5::write_each<std::uint32_t>(group.id(), "cycles", rows, "1", [&](std::size_t row) { return trials[row].cycles; });
  hdf5::write_each<std::uint32_t>(group.id(), "swings", rows, "1", [&](std::size_t row) { return trials[row].swings; });
  hdf5::write_each<double>(group.id(), "settling_time", rows, "s",
                           [&](std::size_t row) { return trials[row].settling_time; });
}

hdf5::Bytes result_bytes(const Study& study, const StudyResult& result) {
  const Plan plan(study);
  const std::vector<std::vector<double>> columns = drawn(plan, result.trials);  // while others may use HDF5
  const hdf5::Session session;
  hdf5::MemoryFile file;
  write_description(file.id(), study, result);
  write_trials(file.id(), study, plan, result.trials);
  write_parameters(file.id(), plan, columns);
  write_audit(file.id(), result.audit);
  if (study.store != Store::all) hdf5::write_sketch(file.id(), result.sketch.value_or(TrialSketch(plan.cells())));
  {
    const hdf5::Handle trajectories = hdf5::create_group(file.id(), "trajectories");
    for (const StudyResult::Retained& retained : result.trajectories) {
      write_trajectory(trajectories.id(), retained.index, retained.trajectory.samples);
    }
  }
  return file.close();
}

}  // namespace

void write_result(const std::filesystem::path& path, const Study& study, const StudyResult& result,
                  const std::filesystem::path& workshop) {
  try {
    const hdf5::Bytes bytes = result_bytes(study, result);
    const std::string seal = seal_of(bytes.span());
    write_whole_file(path, {bytes.span(), std::as_bytes(std::span(seal))}, workshop);
  } catch (const hdf5::Problem& problem) {
    throw RunFailure(fmt::format("cannot write {}: {}", path.string(), problem.what()));
  }
}

}  // namespace steerstat
