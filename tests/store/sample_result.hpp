#pragma once

#include <unistd.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "study/plan.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"

/// Studies and results made up for the tests: every column, every status, no simulation.
namespace steerstat::testing_store {

/// A study with distributions and a sweep of three.
inline Study sample_study(std::uint64_t trials) {
  return decode_study(R"({"name": "sample", "plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
                          "initial_state": {"q2": {"uniform": [-3.1, 3.1]}},
                          "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5, 0.7]}}},
                          "sampling": {"trials": )" +
                          std::to_string(trials) + "}}",
                      {});
}

/// An outcome of every status in turn, with any bits that outcomes may have.
inline TrialOutcome made_up_outcome(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> real(-4.0, 4.0);
  std::uniform_int_distribution<std::uint32_t> count(0, 20);
  TrialOutcome outcome;
  outcome.status = static_cast<Status>(generator() % status_names.size());
  outcome.cycles = count(generator);
  outcome.swings = count(generator);
  outcome.alignments = count(generator);
  outcome.end_time = 150.0 + 30.0 * real(generator);
  outcome.end_state = {real(generator), real(generator), real(generator), real(generator)};
  outcome.passive_error = std::abs(real(generator));
  outcome.active_error = std::abs(real(generator));
  outcome.effort = std::abs(real(generator));
  outcome.peak_acceleration = std::abs(real(generator));
  outcome.peak_force = std::abs(real(generator));
  outcome.peak_stroke = std::abs(real(generator));
  if (outcome.cycles > 0) {
    outcome.position_contraction = {real(generator), real(generator)};
    outcome.velocity_contraction = {real(generator), real(generator)};
  }
  if (outcome.status == Status::diverged) {
    outcome.effort = outcome.peak_force = no_value;
    outcome.end_state.q2_dot = std::numeric_limits<double>::quiet_NaN();
    outcome.end_state.q1 = std::numeric_limits<double>::infinity();
    outcome.end_state.q2 = -0.0;
  }
  return outcome;
}

/// Every trial of `study`, finished; three of them audited.
inline StudyResult made_up_result(const Study& study, unsigned seed = 1) {
  std::mt19937_64 generator(seed);
  StudyResult result;
  const std::uint64_t trials = Plan(study).trials();
  for (std::uint64_t index = 0; index < trials; ++index) {
    result.trials.index.push_back(index);
    result.trials.outcomes.push_back(made_up_outcome(generator));
  }
  result.complete = true;
  result.wall_s = 1.25;
  result.threads = 2;
  result.simd = InstructionSet::avx2;
  result.audit.tolerance = 1e-11;
  for (const std::uint64_t index : {0U, 3U, 10U}) {
    if (index >= trials) continue;
    result.audit.trials.push_back(audited(index, result.trials.outcomes[index]));
    AuditedTrial& trial = result.audit.trials.back();
    trial.settling_time += 1e-8;
    trial.swings += index == 3 ? 1 : 0;  // the one that disagrees
  }
  return result;
}

/// A trajectory of four samples, one in each phase.
inline Trajectory made_up_trajectory() {
  Trajectory trajectory;
  for (const PhaseKind phase : {PhaseKind::align, PhaseKind::drift, PhaseKind::contraction, PhaseKind::swing}) {
    const double t = 0.5 * static_cast<double>(phase);
    trajectory.samples.push_back({t, {1.0 - t, 0.1 * t, -1.0, 0.1}, 2.0 * t, 3.0 * t, phase});
  }
  return trajectory;
}

/// A directory of a test's own, removed with all that is in it.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "steerstat-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary directory");
    path_ = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

inline void set_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

inline std::size_t entries_in(const std::filesystem::path& directory) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(directory), std::filesystem::directory_iterator{}));
}

}  // namespace steerstat::testing_store
