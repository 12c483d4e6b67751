#include "store/study_directory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "core/errors.hpp"
#include "sample_result.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;
using namespace testing_store;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class StudyDirectoryTest : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  /// Keeps trials [begin, end) of `whole_`.
  void keep(StudyDirectory& directory, std::uint64_t begin, std::uint64_t end) const {
    directory.keep(begin, std::span(whole_.trials.outcomes).subspan(begin, end - begin), 1.0);
  }

  /// What a new process finds.
  [[nodiscard]] Recovery recovered() const {
    StudyDirectory directory(path_);
    directory.begin(study_);
    return directory.recover();
  }

  void expect_recovered(const FinishedTrials& finished, const std::vector<std::uint64_t>& index) const {
    ASSERT_EQ(finished.trials.index, index);
    for (std::size_t row = 0; row < index.size(); ++row) {
      EXPECT_TRUE(same_bits(finished.trials.outcomes[row], whole_.trials.outcomes[index[row]])) << "row " << row;
    }
  }

  static std::vector<std::uint64_t> range(std::uint64_t begin, std::uint64_t end) {
    std::vector<std::uint64_t> index;
    for (std::uint64_t i = begin; i < end; ++i) index.push_back(i);
    return index;
  }

  TemporaryDirectory temporary_;
  fs::path path_ = temporary_.path() / "out.h5.parts";
  Study study_ = sample_study(40);  // 120 trials
  StudyResult whole_ = made_up_result(study_);
};

TEST_F(StudyDirectoryTest, IsMadeAndHoldsNothingAtFirst) {
  StudyDirectory directory(path_);
  EXPECT_TRUE(fs::is_directory(path_));
  EXPECT_FALSE(directory.has_shards());
  EXPECT_FALSE(directory.begun());
}

TEST_F(StudyDirectoryTest, GivesBackTheStudyAndTheTrials) {
  {
    StudyDirectory directory(path_);
    directory.begin(study_);
    EXPECT_FALSE(directory.has_shards());
    keep(directory, 0, 32);
    keep(directory, 32, 33);
    keep(directory, 64, 120);
    EXPECT_TRUE(directory.has_shards());
  }
  StudyDirectory directory(path_);
  ASSERT_TRUE(directory.begun());
  EXPECT_EQ(directory.begun()->study, study_);
  directory.begin(study_);
  const Recovery recovery = directory.recover();
  EXPECT_THAT(recovery.set_aside, IsEmpty());
  std::vector<std::uint64_t> index = range(0, 33);
  for (const std::uint64_t i : range(64, 120)) index.push_back(i);
  expect_recovered(recovery.finished, index);
  EXPECT_EQ(recovery.finished.wall_s, 3.0);
}

TEST_F(StudyDirectoryTest, DeletesWhatWasHalfWritten) {
  { StudyDirectory directory(path_); }
  set_bytes(path_ / ".tmp-12-3", "half a shard");
  StudyDirectory directory(path_);
  EXPECT_THAT(names(), ElementsAre("lock"));
}

TEST_F(StudyDirectoryTest, SetsAsideWhatIsDamagedAndKeepsTheRest) {
  {
    StudyDirectory directory(path_);
    directory.begin(study_);
    for (const std::uint64_t begin : {0U, 20U, 40U, 60U}) keep(directory, begin, begin + 20);
  }
  const fs::path flipped = path_ / shard_name(20, 40);
  std::string bytes = bytes_of(flipped);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  set_bytes(flipped, bytes);
  const fs::path cut = path_ / shard_name(60, 80);
  set_bytes(cut, bytes_of(cut).substr(0, 1000));

  const Recovery recovery = recovered();
  std::vector<std::uint64_t> index = range(0, 20);
  for (const std::uint64_t i : range(40, 60)) index.push_back(i);
  expect_recovered(recovery.finished, index);
  ASSERT_EQ(recovery.set_aside.size(), 2U);
  EXPECT_EQ(recovery.set_aside[0].file.filename(), "damaged-" + shard_name(20, 40));
  EXPECT_EQ(recovery.set_aside[1].file.filename(), "damaged-" + shard_name(60, 80));
  EXPECT_THAT(recovery.set_aside[0].reason, HasSubstr("damaged"));
  EXPECT_EQ(bytes_of(recovery.set_aside[0].file), bytes);
  EXPECT_THAT(recovered().set_aside, IsEmpty()) << "once";
}

TEST_F(StudyDirectoryTest, SetsAsideTheSameShardDamagedTwice) {
  for (int time = 0; time < 2; ++time) {
    {
      StudyDirectory directory(path_);
      directory.begin(study_);
      keep(directory, 0, 20);
    }
    set_bytes(path_ / shard_name(0, 20), "damaged");
    EXPECT_EQ(recovered().set_aside.size(), 1U);
  }
  EXPECT_THAT(names(),
              ElementsAre("damaged-2-" + shard_name(0, 20), "damaged-" + shard_name(0, 20), "lock", "study.h5"));
}

TEST_F(StudyDirectoryTest, SetsAsideShardsOfAnotherStudy) {
  Study other = study_;
  other.sampling.seed = 2;
  {
    StudyDirectory directory(path_);
    directory.begin(other);
    keep(directory, 0, 20);
    directory.begin(study_);
    keep(directory, 20, 40);
  }
  const Recovery recovery = recovered();
  expect_recovered(recovery.finished, range(20, 40));
  ASSERT_EQ(recovery.set_aside.size(), 1U);
  EXPECT_THAT(recovery.set_aside[0].reason, HasSubstr("another study"));
}

TEST_F(StudyDirectoryTest, KeepsTheTrialsOfAShorterStudy) {
  {
    StudyDirectory directory(path_);
    directory.begin(sample_study(20));
    keep(directory, 0, 60);
  }
  const Recovery recovery = recovered();
  EXPECT_THAT(recovery.set_aside, IsEmpty());
  expect_recovered(recovery.finished, range(0, 60));
}

TEST_F(StudyDirectoryTest, IsUsableOnceItsDamagedStudyIsSetAside) {
  {
    StudyDirectory directory(path_);
    directory.begin(study_);
    keep(directory, 0, 20);
  }
  set_bytes(path_ / "study.h5", "damaged");
  StudyDirectory directory(path_);
  EXPECT_THROW(directory.begun(), RunFailure);
  EXPECT_EQ(directory.set_study_aside("it is damaged").file.filename(), "damaged-study.h5");
  EXPECT_FALSE(directory.begun());
  directory.begin(study_);
  expect_recovered(directory.recover().finished, range(0, 20));
}

TEST_F(StudyDirectoryTest, IsOfOneProcessAtATime) {
  const StudyDirectory first(path_);
  const auto complaint = [&]() -> std::string {
    try {
      const StudyDirectory second(path_);
      return "";
    } catch (const RunFailure& failure) {
      return failure.what();
    }
  };
  EXPECT_THAT(complaint(), AllOf(HasSubstr(path_.string()), HasSubstr("in use by another process"),
                                 HasSubstr(std::to_string(getpid()))));
}

TEST_F(StudyDirectoryTest, IsFreeAgainHoweverItsProcessEnded) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const StudyDirectory directory(path_);
    std::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_NO_THROW(StudyDirectory{path_});
}

TEST_F(StudyDirectoryTest, BecomesTheResultAndThenHasNoShards) {
  StudyDirectory directory(path_);
  directory.begin(study_);
  keep(directory, 0, 120);
  directory.consolidate(path_ / "results.h5", whole_);
  EXPECT_THAT(names(), ElementsAre("lock", "results.h5", "study.h5"));
  EXPECT_EQ(read_result(path_ / "results.h5").result.trials.outcomes, whole_.trials.outcomes);
  EXPECT_EQ(directory.begun()->study, study_);
}

TEST_F(StudyDirectoryTest, KeepsItsShardsWhereTheResultCannotBeWritten) {
  StudyDirectory directory(path_);
  directory.begin(study_);
  keep(directory, 0, 120);
  EXPECT_THROW(directory.consolidate(temporary_.path() / "missing" / "results.h5", whole_), RunFailure);
  expect_recovered(directory.recover().finished, range(0, 120));
}

TEST_F(StudyDirectoryTest, IsRemovedWithAllThatIsItsOwn) {
  {
    StudyDirectory directory(path_);
    directory.begin(study_);
    keep(directory, 0, 20);
    directory.remove();
  }
  EXPECT_FALSE(fs::exists(path_));
  EXPECT_THAT(fs::is_empty(temporary_.path()), true);
}

TEST_F(StudyDirectoryTest, LeavesWhatIsNotItsOwn) {
  StudyDirectory directory(path_);
  directory.begin(study_);
  set_bytes(path_ / "notes.txt", "mine");
  directory.remove();
  EXPECT_THAT(names(), ElementsAre("notes.txt"));
}

TEST_F(StudyDirectoryTest, ThatCannotBeMadeIsSaidToBe) {
  set_bytes(path_, "a file");
  EXPECT_THROW(StudyDirectory{path_}, RunFailure);
  EXPECT_THROW(StudyDirectory{temporary_.path() / "missing" / "out.h5.parts"}, RunFailure);
}

}  // namespace
}  // namespace steerstat
