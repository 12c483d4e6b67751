#include <chrono>
#include <csignal>
#include <thread>

#include "fault_case.hpp"

namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Resume : public FaultCase {
 protected:
  Resume() { set_spec(spec_of(200000)); }

  /// Ends a run that has kept some trials.
  Ending interrupt(int signal) {
    Process process(STEERSTAT_PROGRAM, arguments());
    while (shards().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    process.send(signal);
    return process.wait();
  }
};

TEST_F(Resume, AfterCtrlCGoesOnFromTheIncompleteResult) {
  const auto expected = undisturbed();
  ASSERT_EQ(interrupt(SIGINT).exit_code, 130);
  EXPECT_FALSE(read_result(out_).result.complete);
  EXPECT_THAT(parts(), IsEmpty());
  const Ending ending = expect_recovery(expected);
  EXPECT_THAT(ending.err, HasSubstr("resuming after"));
}

TEST_F(Resume, AfterCtrlCAndAKillGoesOnFromBoth) {
  const auto expected = undisturbed();
  ASSERT_EQ(interrupt(SIGINT).exit_code, 130);
  const std::uint64_t kept = read_result(out_).result.trials.index.size();
  Process process(STEERSTAT_PROGRAM, arguments({"--resume"}));
  while (shards().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  process.send(SIGKILL);
  ASSERT_EQ(process.wait().signal, SIGKILL);
  EXPECT_EQ(read_result(out_).result.trials.index.size(), kept);
  expect_recovery(expected);
}

TEST_F(Resume, WithNothingToGoOnWithBeginsAtTheBeginning) {
  const auto expected = undisturbed();
  const Ending ending = expect_recovery(expected);
  EXPECT_THAT(ending.err, HasSubstr("resuming after 0 of 200,000 trials"));
}

TEST_F(Resume, OfACompleteResultRunsNothingAndGivesItsSummary) {
  set_spec(spec_of(500));
  const Ending first = steerstat(arguments());
  const std::string bytes = read_file(out_);
  const Ending again = steerstat(arguments({"--resume"}));
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.out, first.out);
  EXPECT_THAT(again.err, HasSubstr("complete; nothing is left to run"));
  EXPECT_EQ(read_file(out_), bytes);
}

TEST_F(Resume, WithMoreTrialsExtendsACompleteResultAndAnInterruptedRun) {
  set_spec(spec_of(230000));
  const auto expected = undisturbed();
  set_spec(spec_of(200000));
  ASSERT_EQ(steerstat(arguments()).exit_code, 0);
  set_spec(spec_of(230000));
  EXPECT_THAT(expect_recovery(expected).err, HasSubstr("resuming after 200,000 of 230,000 trials"));
  fs::remove(out_);
  set_spec(spec_of(200000));
  ASSERT_EQ(interrupt(SIGKILL).signal, SIGKILL);
  set_spec(spec_of(230000));
  expect_recovery(expected);
}

TEST_F(Resume, IsRefusedForAnotherStudyAndLeavesAllAsItWas) {
  ASSERT_EQ(interrupt(SIGKILL).signal, SIGKILL);
  const std::vector<std::string> before = shards();
  set_spec(spec_of(200000, 2));
  const Ending other = steerstat(arguments({"--resume"}));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, AllOf(HasSubstr("another study"), HasSubstr(parts_.string())));
  set_spec(spec_of(100000));
  const Ending fewer = steerstat(arguments({"--resume"}));
  EXPECT_EQ(fewer.exit_code, 2);
  EXPECT_THAT(fewer.err, AllOf(HasSubstr("200,000"), HasSubstr("100,000")));
  EXPECT_EQ(shards(), before);

  set_spec(spec_of(500));
  fs::remove_all(parts_);
  ASSERT_EQ(steerstat(arguments()).exit_code, 0);
  set_spec(spec_of(500, 2));
  const Ending of_result = steerstat(arguments({"--resume"}));
  EXPECT_EQ(of_result.exit_code, 2);
  EXPECT_THAT(of_result.err, AllOf(HasSubstr("another study"), HasSubstr(out_.string())));
  EXPECT_THAT(parts(), IsEmpty());
}

TEST_F(Resume, MustBeAskedForWhereThereAreFinishedTrials) {
  ASSERT_EQ(interrupt(SIGKILL).signal, SIGKILL);
  const std::vector<std::string> before = shards();
  const Ending ending = steerstat(arguments());
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_THAT(ending.err, AllOf(HasSubstr(parts_.string()), HasSubstr("--resume"), HasSubstr("delete")));
  EXPECT_EQ(shards(), before);
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(Resume, NeedNotBeAskedForWhereNothingWasFinished) {
  fs::create_directory(parts_);
  set_spec(spec_of(500));
  EXPECT_EQ(steerstat(arguments()).exit_code, 0);
  EXPECT_FALSE(fs::exists(parts_));
}

TEST_F(Resume, NeedsAnOutputThatIsAFile) {
  const Ending none = steerstat({"run", spec_, "--resume"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("-o"));
  const Ending device = steerstat({"run", spec_, "--resume", "-o", "/dev/null"});
  EXPECT_EQ(device.exit_code, 2);
  EXPECT_THAT(device.err, HasSubstr("not a file"));
}

TEST_F(Resume, OfADirectoryInUseIsRefused) {
  set_spec(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 10, "integrator": {"method": "cvode"},
               "sampling": {"trials": 1000000}})");
  Process first(STEERSTAT_PROGRAM, arguments());
  while (shards().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--resume"}, {}}) {
    const Ending second = steerstat(arguments(more));
    EXPECT_EQ(second.exit_code, 4);
    EXPECT_THAT(second.err, AllOf(HasSubstr(parts_.string()), HasSubstr("in use by another process")));
  }
  first.send(SIGKILL);
  EXPECT_EQ(first.wait().signal, SIGKILL);
}

TEST_F(Resume, GoesOnBesideTheFileThatALinkNames) {
  set_spec(spec_of(500));
  fs::create_directory(scratch_ / "elsewhere");
  ASSERT_EQ(steerstat(arguments()).exit_code, 0);
  fs::rename(out_, scratch_ / "elsewhere/real.h5");
  fs::create_symlink(scratch_ / "elsewhere/real.h5", out_);
  set_spec(spec_of(700));
  const Ending ending = steerstat(arguments({"--resume"}));
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_TRUE(fs::is_symlink(out_));
  EXPECT_EQ(read_result(scratch_ / "elsewhere/real.h5").result.trials.index.size(), 700U);
}

}  // namespace
}  // namespace steerstat::testing
