#include <chrono>
#include <csignal>
#include <iostream>
#include <map>
#include <random>
#include <thread>

#include "fault_case.hpp"

namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;

std::uint64_t trials_in(const std::string& shard) {
  return std::stoull(shard.substr(20, 12)) - std::stoull(shard.substr(7, 12));
}

class Kill : public FaultCase {
 protected:
  /// What is acknowledged: shards under their names. Each must stay as it is until the result is there.
  void note_and_check_shards() {
    if (fs::exists(out_)) {
      EXPECT_TRUE(read_result(out_).result.complete) << "a result must be whole";
    }
    const std::vector<std::string> names = shards();
    if (!fs::exists(out_)) {
      for (const auto& [name, bytes] : acknowledged_) {
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name << " is lost";
      }
    }
    for (const std::string& name : names) {
      const std::string bytes = read_file(parts_ / name);
      const auto [known, is_new] = acknowledged_.try_emplace(name, bytes);
      EXPECT_TRUE(is_new || known->second == bytes) << name << " has changed";
    }
    for (const std::string& name : parts()) EXPECT_FALSE(name.starts_with("damaged-")) << name;
  }

  /// What the last process must have found.
  void expect_resumed(const Ending& ending, std::uint64_t finished) const {
    const std::string key = "resuming after ";
    const std::size_t place = ending.err.find(key);
    if (place == std::string::npos) return;  // killed before it could say so
    std::string count = ending.err.substr(place + key.size());
    count = count.substr(0, count.find(' '));
    std::erase(count, ',');
    EXPECT_EQ(std::stoull(count), finished);
  }

  [[nodiscard]] std::uint64_t acknowledged_trials() const {
    std::uint64_t trials = 0;
    for (const auto& [name, bytes] : acknowledged_) trials += trials_in(name);
    return trials;
  }

  std::map<std::string, std::string> acknowledged_;
};

TEST_F(Kill, AtAnyMomentLosesAndChangesNothing) {
  constexpr unsigned seed = 5;
  const int wanted = wanted_kills();
  std::cout << "seed " << seed << ", " << wanted << " kills\n";
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> milliseconds(0, 500);
  set_spec(spec_of(100000));
  const auto expected = undisturbed();
  int kills = 0;
  std::uint64_t most = 0;
  while (kills < wanted) {
    fs::remove(out_);
    acknowledged_.clear();
    for (bool ended = false; !ended;) {
      const std::uint64_t finished = acknowledged_trials();
      Process process(STEERSTAT_PROGRAM, arguments({"--resume"}));
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
      expect_resumed(ending, finished);
      note_and_check_shards();
      most = std::max(most, acknowledged_trials());
    }
    expect_undisturbed(expected);
  }
  EXPECT_GT(most, 0U) << "no kill came while trials were finished: the study is too short";
}

TEST_F(Kill, IsSurvivedByTheTrialsOfTheReferenceToo) {
  set_spec(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 10, "integrator": {"method": "cvode"},
               "sampling": {"trials": 600}})");
  const auto expected = undisturbed();
  Process process(STEERSTAT_PROGRAM, arguments());
  while (shards().empty() && !fs::exists(out_)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  process.send(SIGKILL);
  EXPECT_EQ(process.wait().signal, SIGKILL);
  expect_recovery(expected);
}

}  // namespace
}  // namespace steerstat::testing
