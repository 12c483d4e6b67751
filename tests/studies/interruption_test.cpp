#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "json_text.hpp"
#include "process.hpp"
#include "store/result_file.hpp"

namespace steerstat::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

std::string drawn(std::uint64_t trials) {
  return R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 10, "integrator": {"method": "cvode"},
             "sampling": {"trials": )" +
         std::to_string(trials) + "}}";
}

Surroundings on_a_terminal() {
  Surroundings surroundings;
  surroundings.columns = 100;
  return surroundings;
}

class Interruption : public ::testing::TestWithParam<int> {};

TEST_P(Interruption, KeepsWhatIsFinishedAndExitsWith130) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", drawn(1000000));
  Process process(STEERSTAT_PROGRAM, {"run", spec, "-o", scratch / "out.h5", "--summary", scratch / "out.json"},
                  on_a_terminal());
  ASSERT_TRUE(process.shows("/s  "));  // the rate: trials are being finished
  process.send(GetParam());
  const Ending ending = process.wait();
  EXPECT_EQ(ending.exit_code, 130);
  EXPECT_THAT(ending.err, HasSubstr("interrupted after"));
  EXPECT_THAT(ending.out, HasSubstr("Incomplete"));

  const StoredStudy stored = read_result(scratch / "out.h5");
  EXPECT_FALSE(stored.result.complete);
  const std::uint64_t kept = stored.result.trials.index.size();
  EXPECT_GT(kept, 0U);
  EXPECT_LT(kept, 1000000U);
  EXPECT_EQ(kept % block_size(stored.study), 0U);
  const Json summary = json_of(read_file(scratch / "out.json"));
  EXPECT_FALSE(summary.at("complete").get<bool>());
  EXPECT_EQ(summary.at("trials").at("requested"), 1000000);
  EXPECT_EQ(summary.at("trials").at("completed"), kept);
  EXPECT_THAT(scratch.names(), ElementsAre("out.h5", "out.json", "spec.json"));

  // What was kept is what an uninterrupted run gives.
  const std::uint64_t compared = std::min<std::uint64_t>(kept, 64);
  const std::string shorter = scratch.file("shorter.json", drawn(compared));
  ASSERT_EQ(steerstat({"run", shorter, "-o", scratch / "shorter.h5"}).exit_code, 0);
  const StoredStudy whole = read_result(scratch / "shorter.h5");
  for (std::size_t row = 0; row < compared; ++row) {
    EXPECT_TRUE(same_bits(stored.result.trials.outcomes[row], whole.result.trials.outcomes[row])) << "trial " << row;
  }
}

TEST_P(Interruption, TheSecondSignalEndsTheProcessAtOnceAndLeavesNoResult) {
  const Scratch scratch;
  // Trials of a million seconds: the first signal alone would leave the process busy for a long time.
  const std::string spec = scratch.file("spec.json", R"({"plant": {"f1": 0.01, "f2": 0.05}, "horizon": 1e6,
      "initial_state": {"q1": {"uniform": [-1, 1]}}, "integrator": {"method": "cvode", "tolerance": 1e-12},
      "sampling": {"trials": 100000}})");
  Process process(STEERSTAT_PROGRAM, {"run", spec, "-o", scratch / "out.h5"}, on_a_terminal());
  ASSERT_TRUE(process.shows("/ 100,000 trials"));
  process.send(GetParam());
  ASSERT_TRUE(process.shows("stopping"));
  process.send(GetParam());
  const Ending ending = process.wait();
  EXPECT_EQ(ending.signal, GetParam());
  EXPECT_EQ(ending.out, "");
  EXPECT_THAT(scratch.names(), ElementsAre("out.h5.parts", "spec.json"));
}

TEST_P(Interruption, DuringTheAuditKeepsTheWholeStudyAndExitsWith130) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"plant": {"f1": 0.01, "f2": {"uniform": [0.03, 0.05]}},
      "sampling": {"trials": 20000}, "audit": {"trials": 20000}})");
  Process process(STEERSTAT_PROGRAM, {"run", spec, "-o", scratch / "out.h5"}, on_a_terminal());
  ASSERT_TRUE(process.shows("100 %"));
  process.send(GetParam());
  const Ending ending = process.wait();
  EXPECT_EQ(ending.exit_code, 130);
  EXPECT_THAT(ending.err, HasSubstr("interrupted during the audit"));
  const StoredStudy stored = read_result(scratch / "out.h5");
  EXPECT_TRUE(stored.result.complete);
  EXPECT_EQ(stored.result.trials.index.size(), 20000U);
  EXPECT_LT(stored.result.audit.trials.size(), 20000U);
}

TEST_P(Interruption, AfterTheLastTrialCostsNothing) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 1})");
  ASSERT_EQ(mkfifo((scratch / "summary").c_str(), 0600), 0);
  Process process(STEERSTAT_PROGRAM, {"run", spec, "-o", scratch / "out.h5", "--summary", scratch / "summary"});
  while (!std::filesystem::exists(scratch / "out.h5")) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  process.send(GetParam());  // while it waits for a reader of its summary
  EXPECT_TRUE(json_of(read_file(scratch / "summary")).at("complete").get<bool>());
  EXPECT_EQ(process.wait().exit_code, 0);
  EXPECT_TRUE(read_result(scratch / "out.h5").result.complete);
}

INSTANTIATE_TEST_SUITE_P(Signals, Interruption, ::testing::Values(SIGINT, SIGTERM),
                         [](const auto& one) { return one.param == SIGINT ? "SIGINT" : "SIGTERM"; });

}  // namespace
}  // namespace steerstat::testing
