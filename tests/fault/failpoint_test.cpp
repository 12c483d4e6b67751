#include <csignal>

#include "fault_case.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;

class Failpoint : public FaultCase, public ::testing::WithParamInterface<std::string> {
 protected:
  /// Runs with the failpoint set to do `action` the n-th time.
  Ending disturbed(int n, const std::string& action) {
    Surroundings surroundings;
    surroundings.environment.push_back("STEERSTAT_FAILPOINT=" + GetParam() + ":" + std::to_string(n) + ":" + action);
    return steerstat(arguments(), surroundings);
  }

  void start_anew() const {
    std::filesystem::remove(out_);
    std::filesystem::remove_all(parts_);
  }
};

TEST_P(Failpoint, ThatKillsCostsNothingThatWasKept) {
  set_spec(spec_of(300));
  const auto expected = undisturbed();
  int n = 1;
  for (;; ++n) {
    SCOPED_TRACE("time " + std::to_string(n));
    start_anew();
    const Ending ending = disturbed(n, "kill");
    if (ending.signal != SIGKILL) {
      EXPECT_EQ(ending.exit_code, 0) << ending.err;
      expect_undisturbed(expected);
      break;
    }
    expect_recovery(expected);
  }
  EXPECT_GT(n, 3) << "a run writes its study, a shard and the result: each step three times";
}

TEST_P(Failpoint, ThatFailsTheStepIsToldAndCostsNothingThatWasKept) {
  set_spec(spec_of(300));
  const auto expected = undisturbed();
  for (const std::string action : {"error", "full"}) {
    int n = 1;
    for (;; ++n) {
      SCOPED_TRACE(action + ", time " + std::to_string(n));
      start_anew();
      const Ending ending = disturbed(n, action);
      if (ending.exit_code == 0) break;
      EXPECT_EQ(ending.exit_code, 4);
      EXPECT_THAT(ending.err, HasSubstr(action == "full" ? "No space left on device" : "Input/output error"));
      EXPECT_THAT(ending.err, HasSubstr(out_.parent_path().string()));
      expect_recovery(expected);
    }
    expect_undisturbed(expected);
    EXPECT_GT(n, 3);
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, Failpoint,
                         ::testing::Values("before-fsync", "after-fsync", "before-close", "after-close",
                                           "before-rename", "after-rename", "before-directory-fsync",
                                           "after-directory-fsync"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace steerstat::testing
