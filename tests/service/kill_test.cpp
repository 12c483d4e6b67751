#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include "../studies/process.hpp"
#include "store/result_file.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;

/// Three studies side by side, one of which extends another.
class ServiceKill : public ::testing::Test {
 protected:
  void new_round(unsigned seed) {
    fs::remove_all(data_);
    fs::remove_all(specs_);
    fs::create_directories(specs_);
    acknowledged_.clear();
    kept_.clear();
    spec_of_.clear();
    for (const auto& [trials, numbers] : {std::pair{20'000, seed}, std::pair{30'000, seed}, std::pair{500, seed + 1}}) {
      const std::string spec = R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
          "initial_state": {"q2": {"uniform": [-3.1, 3.1]}}, "horizon": 60, "audit": {"trials": 2},
          "sampling": {"trials": )" +
                               std::to_string(trials) + R"(, "seed": )" + std::to_string(numbers) + "}}";
      spec_of_[study_id(decode_study(spec, {}))] = spec;
      scratch_.file("specs/" + std::to_string(trials) + ".json", spec);
    }
  }

  /// What was told of, or kept under its name, must be there, and as it was.
  void check(const std::string& told) {
    std::istringstream lines(told);
    for (std::string id; std::getline(lines, id);) {
      if (id.size() == 16) acknowledged_.insert(id);
    }
    for (const std::string& id : acknowledged_) {
      EXPECT_TRUE(fs::exists(fs::path(data_) / "studies" / id / "study.h5")) << id << " is lost";
    }
    for (const auto& [path, bytes] : kept_) {
      if (fs::exists(path.parent_path() / "results.h5")) continue;
      ASSERT_TRUE(fs::exists(path)) << path << " is lost";
      EXPECT_TRUE(read_file(path) == bytes) << path << " has changed";
    }
    if (!fs::exists(data_)) return;
    for (const auto& entry : fs::recursive_directory_iterator(data_)) {
      const std::string name = entry.path().filename().string();
      EXPECT_FALSE(name.starts_with("damaged-")) << name;
      if (name.starts_with("trials-")) kept_[entry.path()] = read_file(entry.path());
    }
  }

  void expect_undisturbed() const {
    for (const auto& [id, spec] : spec_of_) {
      const StoredStudy stored = read_result(fs::path(data_) / "studies" / id / "results.h5");
      const StudyResult expected = run_study(decode_study(spec, {}), {});
      EXPECT_TRUE(stored.result.complete);
      EXPECT_EQ(stored.result.trials.index, expected.trials.index);
      EXPECT_TRUE(stored.result.trials.outcomes == expected.trials.outcomes) << "trials of " << id << " have changed";
    }
  }

  Scratch scratch_;
  std::string data_ = scratch_ / "data";
  std::string specs_ = scratch_ / "specs";
  std::map<std::string, std::string> spec_of_;  // by id
  std::set<std::string> acknowledged_;          // ids
  std::map<fs::path, std::string> kept_;        // shards, with their bytes
};

TEST_F(ServiceKill, AtAnyMomentLosesNoStudyAndLosesOrChangesNoTrial) {
  constexpr unsigned seed = 7;
  const int wanted = wanted_kills();
  std::cout << "seed " << seed << ", " << wanted << " kills\n";
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> milliseconds(0, 400);
  int kills = 0;
  std::size_t most_kept = 0;
  for (unsigned round = 0; kills < wanted; ++round) {
    new_round(100 + 10 * round);
    for (bool ended = false; !ended;) {
      Process process(STEERSTAT_SERVICE_PROCESS, {data_, specs_});
      if (kills < wanted) {
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds(generator)));
        process.send(SIGKILL);
      }
      const Ending ending = process.wait();
      ended = ending.signal != SIGKILL;
      kills += ended ? 0 : 1;
      if (ended) {
        ASSERT_EQ(ending.exit_code, 0) << ending.err;
      }
      check(ending.out);
      most_kept = std::max(most_kept, kept_.size());
    }
    expect_undisturbed();
  }
  EXPECT_GT(most_kept, 0U) << "no kill came while trials were finished: the studies are too short";
}

}  // namespace
}  // namespace steerstat::testing
