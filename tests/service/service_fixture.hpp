#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "../store/sample_result.hpp"
#include "service/study_service.hpp"
#include "store/result_file.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat::testing {

/// A study of short trials, some hundred a millisecond, that retains and audits.
inline std::string quick_spec(std::uint64_t trials, std::uint64_t seed = 1, const std::string& more = "") {
  return R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}}, "horizon": 20,
      "retain": {"trajectories": {"first": 1, "failed": 2}}, "audit": {"trials": 2}, "sampling": {"trials": )" +
         std::to_string(trials) + R"(, "seed": )" + std::to_string(seed) + "}" + more + "}";
}

/// Quick trials that take a second or so, so that a test can come in between; hardly longer beside the address
/// sanitizer, which the kernels are spared, but three times as long beside the thread sanitizer.
#ifdef __SANITIZE_THREAD__
inline constexpr std::uint64_t many_trials = 150'000;
#else
inline constexpr std::uint64_t many_trials = 400'000;
#endif

/// One that takes many seconds: it is always under way while a test looks.
inline std::string long_spec(std::uint64_t seed = 1) {
  return R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
      "initial_state": {"q2": {"uniform": [-3.1, 3.1]}}, "audit": {"trials": 0}, "name": "long",
      "sampling": {"trials": 1000000, "seed": )" +
         std::to_string(seed) + "}}";
}

/// Starts so fast that each trial takes minutes.
inline std::string endless_spec() {
  return R"({"initial_state": {"q2_dot": {"uniform": [1e8, 2e8]}}, "audit": {"trials": 0}, "name": "endless",
      "sampling": {"trials": 1000}})";
}

/// Blocks of trials that take long, a second or so.
inline std::string slow_spec() {
  return R"({"integrator": {"method": "cvode", "tolerance": 1e-12}, "horizon": 100, "plant": {"f2": 0.04},
      "audit": {"trials": 0}, "sampling": {"trials": 100}})";
}

/// A service in a directory of the test's own.
class ServiceCase : public ::testing::Test {
 protected:
  ServiceCase() {
    limits.disk_headroom = 0;
    limits.ending_time = limits.stopping_time = std::chrono::minutes(10);  // however slow the machine
    begin();
  }

  void begin() {
    service =
        std::make_unique<StudyService>(data, 2, limits, [this](const std::string& line) { told.push_back(line); });
  }
  /// Ends the process's service and begins another one, as a restart does.
  void restart() {
    service.reset();
    begin();
  }

  /// The state once it passes; fails the test where it does not within a minute.
  template <class Passes>
  StudyState wait_until(const std::string& id, const Passes& passes) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    StudyState state = service->state(id).value();
    while (!passes(state)) {
      if (std::chrono::steady_clock::now() > deadline) {
        ADD_FAILURE() << id << " stays " << name_of(state.status) << " with " << state.completed << " trials";
        break;
      }
      state = service->wait_for_change(id, state.revision, std::chrono::seconds(1)).value();
    }
    return state;
  }
  StudyState wait_for(const std::string& id, StudyStatus status) {
    return wait_until(id, [&](const StudyState& state) { return state.status == status; });
  }
  StudyState wait_for_end(const std::string& id) {
    return wait_until(id, [](const StudyState& state) { return is_over(state.status); });
  }
  /// Waits until a running study has kept some trials. Looks often: the study must not be over by then.
  void wait_for_kept_trials(const std::string& id) {
    wait_for(id, StudyStatus::running);
    while (service->trials(id, {}, 0, 1).rows.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }

  /// Waits until a study is at work: it has used the processors for a while.
  void wait_for_work(const std::string& id) {
    wait_for(id, StudyStatus::running);
    const std::clock_t begin = std::clock();
    while (std::clock() - begin < CLOCKS_PER_SEC / 10) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }

  /// Expects the result of a study to be that of an undisturbed run, to the bit.
  void expect_undisturbed(const std::string& id, const std::string& spec) {
    const StoredStudy stored = read_result(service->result_file(id).value());
    const StudyResult expected = run_study(decode_study(spec, {}), {});
    EXPECT_TRUE(stored.result.complete);
    EXPECT_EQ(stored.result.trials.index, expected.trials.index);
    EXPECT_EQ(stored.result.trials.outcomes, expected.trials.outcomes);
    EXPECT_EQ(stored.result.audit.trials.size(), expected.audit.trials.size());
  }

  [[nodiscard]] std::filesystem::path home(const std::string& id) const { return data / "studies" / id; }

  testing_store::TemporaryDirectory scratch;
  std::filesystem::path data = scratch.path() / "data";
  ServiceLimits limits;
  std::vector<std::string> told;
  std::unique_ptr<StudyService> service;
};

}  // namespace steerstat::testing
