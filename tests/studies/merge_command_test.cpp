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

std::string spec_of(std::uint64_t trials, const std::string& more = "") {
  return R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
             "initial_state": {"q2": {"uniform": [-3.1, 3.1]}}, "horizon": 30, "audit": {"trials": 2},
             "retain": {"trajectories": {"first": 1, "failed": 2}}, "sampling": {"trials": )" +
         std::to_string(trials) + "}" + more + "}";
}

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class MergeCommand : public ::testing::Test {
 protected:
  void set_spec(const std::string& text) { spec_ = scratch_.file("spec.json", text); }

  [[nodiscard]] std::string shard(int number) const { return scratch_ / ("shard-" + std::to_string(number) + ".h5"); }

  [[nodiscard]] Words run_words(int number, int count) const {
    return {"run",         spec_,     "-o",
            shard(number), "--shard", std::to_string(number) + "/" + std::to_string(count),
            "--threads",   "2",       "--no-progress"};
  }

  /// Runs all shards. @return their files, in order
  Words run_shards(int count) {
    Words files;
    for (int number = 1; number <= count; ++number) {
      const Ending ending = steerstat(run_words(number, count));
      EXPECT_EQ(ending.exit_code, 0) << ending.err;
      files.push_back(shard(number));
    }
    return files;
  }

  [[nodiscard]] Ending merge(const Words& files, const Words& more = {}) const {
    return steerstat(joined(joined({"merge", "-o", out_}, more), files));
  }

  /// Expects a merge to be refused with exit code 2 and a message, and to write nothing.
  void expect_refused(const Words& files, const std::string& message) const {
    const Ending ending = merge(files);
    EXPECT_EQ(ending.exit_code, 2);
    EXPECT_THAT(ending.err, HasSubstr(message));
    EXPECT_FALSE(fs::exists(out_));
  }

  /// Runs the whole study at once. @return how it ended
  Ending run_whole() { return steerstat({"run", spec_, "-o", whole_, "--threads", "2", "--no-progress"}); }

  Scratch scratch_;
  std::string spec_;
  std::string out_ = scratch_ / "out.h5";
  std::string whole_ = scratch_ / "whole.h5";
};

TEST_F(MergeCommand, OfShardsInAnyOrderGivesTheBytesOfOneRun) {
  set_spec(spec_of(2000));
  ASSERT_EQ(run_whole().exit_code, 0);
  Words files = run_shards(5);
  std::reverse(files.begin(), files.end());
  std::swap(files[1], files[3]);
  const Ending ending = merge(files, {"--summary", scratch_ / "out.json"});
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_TRUE(lasting_content_of(out_) == lasting_content_of(whole_));
  Json merged = json_of(read_file(scratch_ / "out.json"));
  Json whole = json_of(steerstat({"show", whole_, "--json"}).out);
  EXPECT_EQ(merged.at("performance").at("threads"), 2);
  merged.erase("performance");
  whole.erase("performance");
  EXPECT_EQ(merged, whole);
}

TEST_F(MergeCommand, OfMoreShardsThanBlocksTakesTheEmptyOnesToo) {
  set_spec(spec_of(200));
  ASSERT_EQ(run_whole().exit_code, 0);
  EXPECT_EQ(merge(run_shards(3)).exit_code, 0);
  auto merged = lasting_content_of(out_);
  auto whole = lasting_content_of(whole_);
  EXPECT_NE(merged["@threads"], whole["@threads"]) << "a shard of one block has work for one thread";
  merged.erase("@threads");
  whole.erase("@threads");
  EXPECT_TRUE(merged == whole);
}

TEST_F(MergeCommand, AShardShowsWhichItIs) {
  set_spec(spec_of(300));
  const Ending ending = steerstat(run_words(2, 3));
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_THAT(ending.out, HasSubstr("Shard 2/3: 128 of 300 trials finished"));
  EXPECT_THAT(steerstat({"show", shard(2)}).out, HasSubstr("Shard 2/3: 128 of 300 trials finished"));
  const StoredStudy stored = read_result(shard(2));
  EXPECT_FALSE(stored.result.complete);
  EXPECT_EQ(stored.result.share, (StudyShare{2, 3}));
  EXPECT_EQ(stored.result.trials.index.front(), 128U);
}

TEST_F(MergeCommand, StopsWhereOneRunWouldHaveAndNeedsNoShardBeyond) {
  set_spec(spec_of(3000, R"(, "stop": {"min_trials": 200, "check_every": 100,
                              "until": [{"metric": "success_rate", "half_width": 0.006}]})"));
  ASSERT_EQ(run_whole().exit_code, 0);
  const std::uint64_t due = read_result(whole_).result.trials.index.size();
  ASSERT_LT(due, 1500U);
  ASSERT_GT(due, 384U) << "so that it is more than the first shard";
  Words files = run_shards(8);
  EXPECT_EQ(merge(files).exit_code, 0);
  EXPECT_TRUE(lasting_content_of(out_) == lasting_content_of(whole_));
  fs::remove(out_);
  files.erase(files.begin() + 5, files.end());
  EXPECT_EQ(merge(files).exit_code, 0);
  EXPECT_TRUE(lasting_content_of(out_) == lasting_content_of(whole_));
  fs::remove(out_);
  files.erase(files.begin());
  expect_refused(files, "of 8 shards, 4 are missing: 1, 6 to 8");
}

TEST_F(MergeCommand, RefusesAMixAndNamesIt) {
  set_spec(spec_of(500));
  const Words files = run_shards(4);
  ASSERT_EQ(run_whole().exit_code, 0);
  const std::string one_of_three = scratch_ / "one_of_three.h5";
  ASSERT_EQ(steerstat({"run", spec_, "-o", one_of_three, "--shard", "1/3"}).exit_code, 0);
  const std::string of_another = scratch_ / "of_another.h5";
  const std::string other_spec = scratch_.file("other.json", spec_of(501));
  ASSERT_EQ(steerstat({"run", other_spec, "-o", of_another, "--shard", "1/4"}).exit_code, 0);
  const std::string copy = scratch_ / "copy.h5";
  fs::copy_file(files[1], copy);

  expect_refused(joined(files, {whole_}), "whole.h5 is no shard of a study");
  expect_refused(joined(files, {of_another}), "of_another.h5 is of another study");
  expect_refused(joined(files, {one_of_three}), "one_of_three.h5 is shard 1/3 and " + files[0] + " is one of 4");
  expect_refused(joined(files, {copy}), "copy.h5 are both shard 2/4");
  expect_refused({files[0], files[3]}, "of 4 shards, 2 are missing: 2 to 3");
  expect_refused({files[0], files[1], files[3]}, "of 4 shards, 1 is missing: 3");

  const Ending over_itself = steerstat(joined({"merge", "-o", files[2]}, files));
  EXPECT_EQ(over_itself.exit_code, 2);
  EXPECT_THAT(over_itself.err, HasSubstr("is a shard itself and would be overwritten"));

  fs::resize_file(copy, fs::file_size(copy) - 100);
  const Ending damaged = merge({files[0], copy, files[2], files[3]});
  EXPECT_EQ(damaged.exit_code, 4);
  EXPECT_THAT(damaged.err, HasSubstr("copy.h5"));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(MergeCommand, GatesAreJudgedByMergeAlone) {
  set_spec(spec_of(600, R"(, "gates": [{"metric": "peak_stroke", "expr": "max < 0"}])"));
  const Words files = run_shards(2);  // which expects them to exit with 0
  const Ending ending = merge(files, {"--junit", scratch_ / "gates.xml"});
  EXPECT_EQ(ending.exit_code, 1) << ending.err;
  EXPECT_THAT(read_file(scratch_ / "gates.xml"), HasSubstr("failures=\"1\""));
  EXPECT_TRUE(read_result(out_).result.complete);
}

TEST_F(MergeCommand, BadUseOfShardsIsFoundBeforeAnythingRuns) {
  set_spec(spec_of(1000000));
  const auto expect_bad = [&](const Words& more, const std::string& message) {
    const Ending ending = steerstat(joined({"run", spec_}, more));
    EXPECT_EQ(ending.exit_code, 2) << message;
    EXPECT_THAT(ending.err, HasSubstr(message));
  };
  expect_bad({"-o", out_, "--shard", "0/4"}, "--shard: '0/4' is no shard");
  expect_bad({"-o", out_, "--shard", "5/4"}, "--shard: '5/4' is no shard");
  expect_bad({"-o", out_, "--shard", "one"}, "--shard: 'one' is no shard");
  expect_bad({"--shard", "1/4"}, "--shard: without -o");
  expect_bad({"-o", out_, "--shard", "1/4", "--junit", scratch_ / "a.xml"}, "give them to merge");
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(MergeCommand, AnInterruptedShardIsUnfinished) {
  set_spec(spec_of(4000000));
  const fs::path parts = scratch_ / "shard-1.h5.parts";
  {
    Process process(STEERSTAT_PROGRAM, run_words(1, 2));
    while (!fs::exists(parts)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    process.send(SIGINT);
    EXPECT_EQ(process.wait().exit_code, 130);
  }
  ASSERT_LT(read_result(shard(1)).result.trials.index.size(), 2000000U) << "15,625 of the 31,250 blocks";
  expect_refused({shard(1)}, "shard-1.h5 is unfinished");
  Words another = joined(run_words(2, 2), {"--resume"});
  another[3] = shard(1);
  const Ending refused = steerstat(another);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("is of shard 1/2 of it and this run is of shard 2/2 of it"));
}

TEST_F(MergeCommand, AKilledShardGoesOnWhenItIsResumed) {
  set_spec(spec_of(280000));
  const fs::path parts = scratch_ / "shard-1.h5.parts";
  // The second file of trials, after the study's: one is written, at the latest, when 65,536 trials wait.
  Surroundings surroundings;
  surroundings.environment.emplace_back("STEERSTAT_FAILPOINT=after-rename:3:kill");
  ASSERT_EQ(steerstat(run_words(1, 2), surroundings).signal, SIGKILL);
  EXPECT_TRUE(fs::exists(parts));
  EXPECT_FALSE(fs::exists(shard(1)));
  const Ending resumed = steerstat(joined(run_words(1, 2), {"--resume"}));
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("of 140,032 trials"));  // 1,094 of the 2,188 blocks
  EXPECT_FALSE(fs::exists(parts));
  EXPECT_THAT(steerstat(joined(run_words(1, 2), {"--resume"})).err, HasSubstr("nothing is left to run"));
  EXPECT_EQ(read_result(shard(1)).result.trials.index.size(), 140032U);
}

TEST_F(MergeCommand, TheTasksOfAJobArrayAreShardsThatMerge) {
  set_spec(spec_of(500));
  ASSERT_EQ(run_whole().exit_code, 0);
  Words shards;
  for (const char* task : {"3", "1", "2"}) {
    Surroundings of_task;
    of_task.environment = {"PATH=/usr/bin:/bin",           "LANG=C.UTF-8",
                           "STEERSTAT=" STEERSTAT_PROGRAM, "SLURM_ARRAY_TASK_COUNT=3",
                           "SLURM_CPUS_PER_TASK=2",        std::string("SLURM_ARRAY_TASK_ID=") + task};
    Process process("/bin/bash", {STEERSTAT_SOURCE_DIR "/studies/slurm/array.sbatch", spec_, out_}, of_task);
    const Ending ending = process.wait();
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    shards.push_back(out_ + ".shards/" + task + ".h5");
  }
  EXPECT_EQ(merge(shards).exit_code, 0);
  EXPECT_TRUE(lasting_content_of(out_) == lasting_content_of(whole_));
}

}  // namespace
}  // namespace steerstat::testing
