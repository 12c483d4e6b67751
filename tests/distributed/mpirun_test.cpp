#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "file_content.hpp"
#include "process.hpp"
#include "store/result_file.hpp"

/// The program under mpirun, as users start it.
namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

/// Times that a text is in another.
int count_in(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

class Mpirun : public ::testing::Test {
 protected:
  static std::string spec_of(std::uint64_t trials, const std::string& more = "") {
    return R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
               "initial_state": {"q2": {"uniform": [-3.1, 3.1]}}, "horizon": 60, "audit": {"trials": 2},
               "retain": {"trajectories": {"first": 1, "failed": 2}}, "sampling": {"trials": )" +
           std::to_string(trials) + "}" + more + "}";
  }

  void set_spec(const std::string& text) { spec_ = scratch_.file("spec.json", text); }

  [[nodiscard]] Words words(int ranks, const Words& more) const {
    Words all{"--allow-run-as-root",
              "--oversubscribe",
              "-n",
              std::to_string(ranks),
              STEERSTAT_PROGRAM,
              "run",
              spec_,
              "--threads",
              "1",
              "--no-progress"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  /// mpirun looks for its own programs, and keeps its session in TMPDIR.
  static Surroundings surroundings() {
    Surroundings result;
    result.environment = {"PATH=/usr/bin:/bin", "HOME=/tmp", "LANG=C.UTF-8", "TERM=xterm"};
    return result;
  }

  [[nodiscard]] Ending mpirun(int ranks, const Words& more) const {
    return Process(MPIRUN_PROGRAM, words(ranks, more), surroundings()).wait();
  }

  /// The content of the result of one process but for what tells the machines.
  std::map<std::string, std::string> alone() {
    const std::string path = scratch_ / "alone.h5";
    EXPECT_EQ(steerstat({"run", spec_, "-o", path, "--no-progress"}).exit_code, 0);
    return datasets_of(path);
  }

  static std::map<std::string, std::string> datasets_of(const fs::path& path) {
    auto content = lasting_content_of(path);
    content.erase("@threads");
    return content;
  }

  /// The process of a rank; 0 where there is none.
  [[nodiscard]] pid_t process_of(int rank) const {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string name = entry.path().filename().string();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      std::error_code gone;
      if (fs::read_symlink(entry.path() / "exe", gone) != fs::canonical(STEERSTAT_PROGRAM)) continue;
      if (read_file(entry.path() / "cmdline").find(spec_) == std::string::npos) continue;
      const std::string environment = '\0' + read_file(entry.path() / "environ");
      const std::string wanted = '\0' + ("OMPI_COMM_WORLD_RANK=" + std::to_string(rank)) + '\0';
      if (environment.find(wanted) != std::string::npos) return static_cast<pid_t>(std::stol(name));
    }
    return 0;
  }

  [[nodiscard]] bool has_parts() const {
    std::error_code none;
    for (const auto& file : fs::directory_iterator(out_ + ".parts", none)) {
      if (file.path().filename().string().starts_with("trials-")) return true;
    }
    return false;
  }

  Scratch scratch_;
  std::string spec_;
  std::string out_ = scratch_ / "out.h5";
};

TEST_F(Mpirun, GivesTheBytesOfOneProcessOnOneTwoAndFourRanks) {
  set_spec(spec_of(5000));
  const auto expected = alone();
  const auto expect_same = [&](int ranks, const Words& more) {
    Words all{"-o", out_};
    all.insert(all.end(), more.begin(), more.end());
    const Ending ending = mpirun(ranks, all);
    ASSERT_EQ(ending.exit_code, 0) << ending.err;
    EXPECT_EQ(count_in(ending.out, "5,000 trials in "), 1) << ending.out;
    EXPECT_EQ(count_in(ending.out, "\x1b"), 0) << "colours in what is no terminal:\n" << ending.out;
    EXPECT_EQ(count_in(ending.err, "wrote the trials to"), 1) << ending.err;
    EXPECT_TRUE(datasets_of(out_) == expected) << ranks << " ranks";
    EXPECT_EQ(read_result(out_).result.threads, static_cast<unsigned>(ranks));
    EXPECT_FALSE(fs::exists(out_ + ".parts"));
    fs::remove(out_);
  };
  for (const int ranks : {1, 2, 4}) expect_same(ranks, {});
  expect_same(2, {"--gather"});
  expect_same(2, {"--ask-every", "0.01"});
}

TEST_F(Mpirun, AKilledRankCostsOnlyItsUnfinishedBlocks) {
  set_spec(spec_of(300000));
  const auto expected = alone();
  {
    Process process(MPIRUN_PROGRAM, words(2, {"-o", out_}), surroundings());
    while (!has_parts()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const pid_t victim = process_of(1);
    ASSERT_GT(victim, 0);
    ASSERT_EQ(kill(victim, SIGKILL), 0);
    EXPECT_NE(process.wait().exit_code, 0);
  }
  while (process_of(0) > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(fs::exists(out_));
  ASSERT_TRUE(has_parts());
  const Ending resumed = mpirun(2, {"-o", out_, "--resume"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("resuming after"));
  EXPECT_THAT(resumed.err, Not(HasSubstr("resuming after 0 of")));
  EXPECT_TRUE(datasets_of(out_) == expected);
}

TEST_F(Mpirun, AShardIsARunOfItsOwnWhateverStartsIt) {
  set_spec(spec_of(2000));
  const auto expected = alone();
  const Words shards{scratch_ / "1.h5", scratch_ / "2.h5"};
  // Two programs in one job, in the words of mpirun: each of one rank.
  Words both{"--allow-run-as-root", "--oversubscribe"};
  for (const std::size_t shard : {1U, 2U}) {
    for (const std::string& word : {std::string("-n"), std::string("1"), std::string(STEERSTAT_PROGRAM),
                                    std::string("run"), spec_, std::string("--no-progress"), std::string("--shard"),
                                    std::to_string(shard) + "/2", std::string("-o"), shards[shard - 1]}) {
      both.push_back(word);
    }
    if (shard == 1) both.emplace_back(":");
  }
  const Ending ending = Process(MPIRUN_PROGRAM, both, surroundings()).wait();
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  ASSERT_EQ(steerstat({"merge", shards[1], shards[0], "-o", out_}).exit_code, 0);
  EXPECT_TRUE(datasets_of(out_) == expected);
}

TEST_F(Mpirun, RanksThatAreGivenTheSameShardAreToldAndRunItOnce) {
  set_spec(spec_of(1000000000, R"(, "store": "summary")"));  // under way whenever the other rank comes
  const Ending ending = mpirun(2, {"--shard", "1/2", "-o", out_});
  EXPECT_EQ(ending.exit_code, 4);
  EXPECT_EQ(count_in(ending.err, "steerstat: " + out_ + ".parts is in use by another process"), 1) << ending.err;
}

TEST_F(Mpirun, OptionsOfRanksAreRefusedWhereThereAreNone) {
  set_spec(spec_of(2000));
  const Ending ending = mpirun(1, {"--shard", "1/2", "-o", out_, "--gather"});
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_THAT(ending.err, HasSubstr("steerstat: --gather: a shard runs in one process"));
  EXPECT_THAT(steerstat({"run", spec_, "--ask-every", "1"}).err,
              HasSubstr("steerstat: --ask-every: this process is alone"));
}

TEST_F(Mpirun, EveryRankEndsWithTheExitCodeAndOneSpeaks) {
  set_spec(spec_of(300, R"(, "gates": [{"metric": "peak_stroke", "expr": "max < 0"}])"));
  EXPECT_EQ(mpirun(2, {}).exit_code, 1);
  const Ending usage = mpirun(2, {"--resume"});
  EXPECT_EQ(usage.exit_code, 2);
  EXPECT_EQ(count_in(usage.err, "steerstat: --resume: without -o"), 1) << usage.err;
  set_spec(R"({"plant": {"m1": -1}})");
  const Ending bad = mpirun(2, {"-o", out_});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(count_in(bad.err, "/plant/m1"), 1) << bad.err;
}

}  // namespace
}  // namespace steerstat::testing
