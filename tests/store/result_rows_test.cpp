#include "store/result_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/errors.hpp"
#include "sample_result.hpp"
#include "store/hdf5.hpp"
#include "store/result_file.hpp"
#include "store/seal.hpp"

namespace steerstat {
namespace {

using namespace testing_store;
using ::testing::HasSubstr;

class Rows : public testing::Test {
 protected:
  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "result.h5";
};

TEST_F(Rows, AreThoseOfTheWholeFileToTheBit) {
  const Study study = sample_study(30'000);  // 90,000 trials: more than are read together
  const StudyResult result = made_up_result(study);
  write_result(path_, study, result);
  const ResultRows rows(path_);
  const std::vector<std::uint64_t> wanted{0, 1, 2, 40'000, 65'535, 65'536, 65'537, 89'999};
  const std::vector<TrialOutcome> outcomes = rows.outcomes(wanted);
  ASSERT_EQ(outcomes.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_TRUE(same_bits(outcomes[i], result.trials.outcomes[wanted[i]])) << wanted[i];
  }
  const std::vector<Status> statuses = rows.statuses();
  ASSERT_EQ(statuses.size(), 90'000U);
  EXPECT_EQ(statuses[65'536], result.trials.outcomes[65'536].status);
  EXPECT_TRUE(rows.outcomes({}).empty());
}

TEST_F(Rows, BeyondTheLastAreNone) {
  const Study study = sample_study(10);
  write_result(path_, study, made_up_result(study));
  const std::vector<std::uint64_t> last{29};
  EXPECT_EQ(ResultRows(path_).outcomes(last).size(), 1U);
  const std::vector<std::uint64_t> beyond{30};
  try {
    static_cast<void>(ResultRows(path_).outcomes(beyond));
    FAIL() << "there is none";
  } catch (const RunFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr(path_.string() + ": it has no trial 30"));
  }
}

TEST_F(Rows, ASealHoldsUntilAByteChanges) {
  const Study study = sample_study(10);
  write_result(path_, study, made_up_result(study));
  EXPECT_TRUE(is_sealed(path_));
  const std::string whole = bytes_of(path_);
  for (const std::size_t place : {std::size_t{0}, whole.size() / 2, whole.size() - 2}) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 1);
    set_bytes(path_, damaged);
    EXPECT_FALSE(is_sealed(path_)) << place;
  }
  set_bytes(path_, whole.substr(0, whole.size() - 1));
  EXPECT_FALSE(is_sealed(path_)) << "cut short";
  set_bytes(path_, "");
  EXPECT_FALSE(is_sealed(path_));
  std::filesystem::remove(path_);
  EXPECT_THROW(is_sealed(path_), RunFailure);
}

TEST(Hdf5Session, LetsThoseWhoWaitGoFirst) {
  std::atomic<bool> begun{false};
  std::atomic<bool> served{false};
  std::thread other;
  {
    const hdf5::Session session;
    other = std::thread([&] {
      begun = true;
      const hdf5::Session turn;
      served = true;
    });
    while (!begun) std::this_thread::yield();
    EXPECT_FALSE(served);
    while (!served) hdf5::Session::give_way();  // for ever, if it did not
  }
  other.join();
}

}  // namespace
}  // namespace steerstat
