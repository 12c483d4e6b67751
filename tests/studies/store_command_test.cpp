// "store" as users meet it: what the program makes of studies that do not keep all rows, and what it refuses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "file_content.hpp"
#include "json_text.hpp"
#include "process.hpp"
#include "store/result_file.hpp"

namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

class StoreCommand : public ::testing::Test {
 protected:
  std::string spec_of(const std::string& store, std::uint64_t trials, const std::string& more = "", int horizon = 30) {
    return scratch_.file(store + ".json",
                         R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
             "initial_state": {"q2": {"uniform": [-3.1, 3.1]}}, "audit": {"trials": 2}, "horizon": )" +
                             std::to_string(horizon) + R"(, "store": ")" + store +
                             R"(", "retain": {"trajectories": {"first": 1, "failed": 2}},
             "sampling": {"trials": )" +
                             std::to_string(trials) + "}" + more + "}");
  }

  [[nodiscard]] Ending run(const std::string& spec, const std::string& out, const Words& more = {}) const {
    Words words{"run", spec, "-o", out, "--threads", "2", "--no-progress"};
    words.insert(words.end(), more.begin(), more.end());
    return steerstat(words);
  }

  Scratch scratch_;
  std::string out_ = scratch_ / "out.h5";
};

constexpr const char* swept = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5, 0.7]}}})";

TEST_F(StoreCommand, AShownSummaryIsTheRunsAndRightWithinTheStatedError) {
  ASSERT_EQ(run(spec_of("summary", 500, swept, 150), out_).exit_code, 0);
  const std::string rows = scratch_ / "rows.h5";
  ASSERT_EQ(run(spec_of("all", 500, swept, 150), rows).exit_code, 0);
  const Json sketched = json_of(steerstat({"show", out_, "--json"}).out);
  const Json exact = json_of(steerstat({"show", rows, "--json"}).out);
  EXPECT_EQ(sketched.at("sketch").at("store"), "summary");
  EXPECT_FALSE(exact.contains("sketch"));
  const double error = sketched.at("sketch").at("relative_error");
  EXPECT_EQ(sketched.at("outcomes"), exact.at("outcomes"));
  ASSERT_GT(exact.at("outcomes").at("converged"), 100);
  EXPECT_EQ(sketched.at("audit").at("agree"), exact.at("audit").at("agree"));
  for (const char* bound : {"ci_low", "ci_high"}) {
    EXPECT_NEAR(sketched.at("success_rate").at(bound), exact.at("success_rate").at(bound), 1e-12) << "over the draws";
    EXPECT_EQ(sketched.at("cells").at(1).at("success_rate").at(bound),
              exact.at("cells").at(1).at("success_rate").at(bound));
  }
  for (const Json* pair : {&sketched, &sketched.at("cells").at(2)}) {
    const Json& other = pair == &sketched ? exact : exact.at("cells").at(2);
    for (const char* metric : {"settling_time", "peak_force", "velocity_contraction_worst"}) {
      ASSERT_EQ(pair->at(metric).at("mean").is_null(), other.at(metric).at("mean").is_null());
      if (other.at(metric).at("mean").is_null()) continue;
      for (const char* moment : {"mean", "min", "max"}) {
        EXPECT_EQ(pair->at(metric).at(moment), other.at(metric).at(moment)) << metric << ' ' << moment;
      }
      for (const char* quantile : {"p05", "p50", "p95", "p99"}) {
        const double expected = other.at(metric).at(quantile);
        EXPECT_NEAR(pair->at(metric).at(quantile), expected, error * std::abs(expected)) << metric << ' ' << quantile;
      }
    }
  }
}

TEST_F(StoreCommand, ShardsInAnyOrderMergeToTheBytesOfOneRun) {
  for (const char* store : {"failed", "summary"}) {
    const std::string spec = spec_of(store, 700, swept);
    ASSERT_EQ(run(spec, out_).exit_code, 0);
    Words merge{"merge", "-o", scratch_ / "merged.h5"};
    for (const char* number : {"3", "1", "2"}) {
      const std::string shard = scratch_ / (std::string("shard") + number + ".h5");
      ASSERT_EQ(run(spec, shard, {"--shard", std::string(number) + "/3"}).exit_code, 0);
      merge.push_back(shard);
    }
    ASSERT_EQ(steerstat(merge).exit_code, 0);
    EXPECT_TRUE(lasting_content_of(scratch_ / "merged.h5") == lasting_content_of(out_)) << store;
    merge.pop_back();
    const Ending lacking = steerstat(merge);
    EXPECT_EQ(lacking.exit_code, 2);
    EXPECT_THAT(lacking.err, HasSubstr("of 3 shards, 1 is missing: 2"));
  }
}

TEST_F(StoreCommand, AKilledRunGoesOnToTheSameBytes) {
  const std::string spec = spec_of("failed", 150000);
  {
    Process process(STEERSTAT_PROGRAM, {"run", spec, "-o", out_, "--threads", "1", "--no-progress"});
    const auto has_parts = [&] {
      std::error_code none;
      for (const auto& file : fs::directory_iterator(out_ + ".parts", none)) {
        if (file.path().filename().string().starts_with("trials-")) return true;
      }
      return false;
    };
    while (!has_parts()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    process.send(SIGKILL);
    process.wait();
  }
  const std::string small = spec_of("failed", 3000);
  EXPECT_EQ(run(small, out_, {"--resume"}).exit_code, 2) << "a study can be extended, not cut";
  EXPECT_TRUE(fs::exists(out_ + ".parts"));
  const Ending resumed = run(spec_of("failed", 150000), out_, {"--resume"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("resuming after"));
  const std::string straight = scratch_ / "straight.h5";
  ASSERT_EQ(run(spec, straight).exit_code, 0);
  EXPECT_TRUE(lasting_content_of(out_) == lasting_content_of(straight));
}

TEST_F(StoreCommand, AnyTrialReplaysAndWhatNeedsRowsSaysSo) {
  ASSERT_EQ(run(spec_of("summary", 300), out_).exit_code, 0);
  const std::string rows = scratch_ / "rows.h5";
  ASSERT_EQ(run(spec_of("all", 300), rows).exit_code, 0);
  for (const char* trial : {"0", "123", "299"}) {
    const Ending replayed = steerstat({"replay", out_, "--trial", trial});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_EQ(replayed.out, steerstat({"replay", rows, "--trial", trial}).out);
  }
  EXPECT_EQ(steerstat({"replay", out_, "--trial", "300"}).exit_code, 2);
  for (const Words& words : {Words{"compare", rows, out_}, Words{"show", out_, "--sensitivity"}}) {
    const Ending refused = steerstat(words);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("needs the row of every trial; run the study with \"store\": \"all\""));
  }
  const Ending exported = steerstat({"export", out_, "-o", scratch_ / "out.csv"});
  EXPECT_EQ(exported.exit_code, 0);
  EXPECT_THAT(exported.err, HasSubstr("of 300 trials these are the ones whose rows were kept"));
}

TEST_F(StoreCommand, AStudyThatStopsRunsInOneProcess) {
  const std::string spec =
      spec_of("summary", 3000, R"(, "stop": {"until": [{"metric": "success_rate", "half_width": 0.2}]})");
  const Ending shard = run(spec, out_, {"--shard", "1/2"});
  EXPECT_EQ(shard.exit_code, 2);
  EXPECT_THAT(shard.err, HasSubstr("--shard: the spec has a \"stop\" and does not store all rows"));
  EXPECT_FALSE(fs::exists(out_ + ".parts"));
  const Ending alone = run(spec, out_);
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(read_result(out_).result.finished(), 1000U);
}

}  // namespace
}  // namespace steerstat::testing
