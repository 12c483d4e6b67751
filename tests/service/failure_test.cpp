#include <cstdlib>
#include <fstream>

#include "core/errors.hpp"
#include "service_fixture.hpp"

namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Failure : public ServiceCase {
 protected:
  Failure() { set_failpoint(""); }
  ~Failure() override { set_failpoint(""); }

  /// To be called while the service writes nothing.
  static void set_failpoint(const std::string& value) {
    setenv("STEERSTAT_FAILPOINT", value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe): nobody reads it meanwhile
  }

  /// Files of a study whose names begin so.
  [[nodiscard]] std::vector<fs::path> files(const std::string& id, const std::string& prefix) const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(home(id))) {
      if (entry.path().filename().string().starts_with(prefix)) found.push_back(entry.path());
    }
    return found;
  }

  /// A study that was stopped in the middle; the service is not there then.
  std::string interrupted(const std::string& spec) {
    const std::string id = service->submit(spec).state.id;
    wait_for_kept_trials(id);
    service.reset();
    EXPECT_FALSE(fs::exists(home(id) / "results.h5"));
    return id;
  }
};

TEST_F(Failure, OfAShardIsToldAndItsTrialsRunAgain) {
  const std::string spec = quick_spec(many_trials);
  const std::string id = interrupted(spec);
  const fs::path shard = files(id, "trials-").at(0);
  std::string bytes = testing_store::bytes_of(shard);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  testing_store::set_bytes(shard, bytes);
  begin();
  wait_for(id, StudyStatus::succeeded);
  service->stop();
  EXPECT_THAT(told, Contains(HasSubstr("its trials run again")));
  expect_undisturbed(id, spec);
}

TEST_F(Failure, OfOneStudysFileSetsItAsideAndHindersNoOther) {
  const std::string good = service->submit(quick_spec(100)).state.id;
  wait_for(good, StudyStatus::succeeded);
  const std::string bad = interrupted(quick_spec(many_trials, 2));
  testing_store::set_bytes(home(bad) / "study.h5", "nonsense");
  begin();
  EXPECT_FALSE(service->state(bad));
  EXPECT_EQ(service->state(good)->status, StudyStatus::succeeded);
  EXPECT_TRUE(fs::exists(home("damaged-" + bad))) << "its trials are not thrown away";
  EXPECT_THAT(told, Contains(HasSubstr("damaged-" + bad)));
  restart();
  EXPECT_EQ(service->list(10).studies.size(), 1U) << "nobody trips over it again";
}

TEST_F(Failure, OfTheStudyFileBesideAWholeResultCostsNothing) {
  const std::string id = service->submit(quick_spec(100)).state.id;
  wait_for(id, StudyStatus::succeeded);
  service.reset();
  testing_store::set_bytes(home(id) / "study.h5", "nonsense");
  testing_store::set_bytes(home(id) / "state.json", "nonsense");
  begin();
  EXPECT_EQ(service->state(id)->status, StudyStatus::succeeded);
  EXPECT_EQ(service->state(id)->completed, 100U);
  expect_undisturbed(id, quick_spec(100));
}

TEST_F(Failure, OfTheProcessBeforeAStudyWasAcknowledgedOrAfterItWasRemovedLeavesNothing) {
  service.reset();
  fs::create_directories(home("0123456789abcdef"));
  std::ofstream(home("0123456789abcdef") / "state.json") << "{}";
  fs::create_directories(home(".removed-fedcba9876543210"));
  begin();
  EXPECT_THAT(service->list(10).studies, IsEmpty());
  EXPECT_EQ(testing_store::entries_in(data / "studies"), 0U);
}

TEST_F(Failure, OfTheProcessBetweenAResultAndItsRecordRunsNothingAgain) {
  const std::string id = service->submit(quick_spec(300)).state.id;
  wait_for(id, StudyStatus::succeeded);
  service.reset();
  std::string record = testing_store::bytes_of(home(id) / "state.json");
  record.replace(record.find("succeeded"), 9, "queued");
  testing_store::set_bytes(home(id) / "state.json", record);
  begin();
  wait_for(id, StudyStatus::succeeded);
  EXPECT_EQ(service->counters().trials_done, 0U);
  expect_undisturbed(id, quick_spec(300));
}

TEST_F(Failure, OfAnyStepOfASubmissionAcknowledgesNothingAndLeavesNothing) {
  for (const std::string moment : {"before", "after"}) {
    for (const std::string step : {"fsync", "close", "rename", "directory-fsync"}) {
      for (const std::string number : {"1", "2"}) {
        const std::string place = moment + "-" + step + ":" + number + ":error";
        set_failpoint(place);
        EXPECT_THROW(service->submit(quick_spec(20)), RunFailure) << place;
        set_failpoint("");
        EXPECT_THAT(service->list(10).studies, IsEmpty()) << place;
        EXPECT_EQ(testing_store::entries_in(data / "studies"), 0U) << place;
      }
    }
  }
  EXPECT_TRUE(service->submit(quick_spec(20)).created);
}

TEST_F(Failure, OfAFullDiskFailsThatStudyKeepsItsTrialsAndTheServiceGoesOn) {
  // The first two files are the submission's; the fifth is a shard.
  set_failpoint("before-fsync:5:full");
  const std::string spec = quick_spec(many_trials);
  const std::string id = service->submit(spec).state.id;
  const StudyState failed = wait_for_end(id);
  set_failpoint("");
  EXPECT_EQ(failed.status, StudyStatus::failed);
  EXPECT_THAT(failed.failure.value_or(""), HasSubstr("No space left on device"));
  EXPECT_THAT(failed.failure.value_or(""), HasSubstr("its finished trials are kept"));
  EXPECT_GT(failed.completed, 0U);
  EXPECT_EQ(service->trials(id, {}, 0, 1'000'000).rows.size(), failed.completed);
  wait_for(service->submit(quick_spec(100)).state.id, StudyStatus::succeeded);
  EXPECT_FALSE(service->submit(spec).created);
  wait_for(id, StudyStatus::succeeded);
  expect_undisturbed(id, spec);
}

TEST_F(Failure, OfAnyStepOfTheResultIsMadeGoodByTheNextSubmission) {
  // A study of one shard: its files are state, study, shard, result, summary, state. The submission also makes, and
  // syncs, a directory.
  std::uint64_t seed = 10;
  for (const std::string step : {"fsync", "rename", "directory-fsync"}) {
    const int first = step == "directory-fsync" ? 4 : 3;
    for (int number = first; number < first + 4; ++number) {
      const std::string place = "before-" + step + ":" + std::to_string(number) + ":full";
      set_failpoint(place);
      const std::string spec = quick_spec(40, ++seed);
      const std::string id = service->submit(spec).state.id;
      wait_for_end(id);
      set_failpoint("");
      service->submit(spec);
      wait_for(id, StudyStatus::succeeded);
      restart();
      wait_for(id, StudyStatus::succeeded);
      expect_undisturbed(id, spec);
      EXPECT_THAT(service->summary(id).json, HasSubstr("\"complete\": true")) << place;
    }
  }
}

TEST_F(Failure, ToNoteHowAStudyEndedIsToldAndMadeGoodOnceItCanBe) {
  service.reset();
  limits.wall_time = std::chrono::seconds(1);
  begin();
  const std::string id = service->submit(long_spec()).state.id;
  wait_for(id, StudyStatus::running);
  const fs::path record = home(id) / "state.json";
  fs::remove(record);
  fs::create_directory(record);  // in the way of every further record
  EXPECT_EQ(wait_for_end(id).status, StudyStatus::failed);
  fs::remove(record);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!fs::exists(record) && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  restart();
  EXPECT_THAT(told, Contains(HasSubstr("how study " + id + " ended (failed) is not on the disk")));
  EXPECT_THAT(told, Contains(HasSubstr("how study " + id + " ended is on the disk now")));
  EXPECT_EQ(service->state(id)->status, StudyStatus::failed) << "it does not run again by itself";
  EXPECT_THAT(service->state(id)->failure.value_or(""), HasSubstr("as long as a study may"));
}

TEST_F(Failure, ThatNobodyCouldNoteIsToldAtTheNextStart) {
  const std::string id = interrupted(quick_spec(many_trials));
  begin();
  EXPECT_THAT(told, Contains("study " + id + " was not over when the service ended: it goes on"));
  wait_for(id, StudyStatus::succeeded);
}

TEST_F(Failure, OfTheDiskToHaveRoomRefusesAStudyBeforeItBegins) {
  service.reset();
  limits.disk_headroom = std::uint64_t{1} << 60U;
  begin();
  try {
    service->submit(quick_spec(20));
    FAIL() << "there is no exbibyte";
  } catch (const RunFailure& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("the disk is full"));
  }
  EXPECT_THAT(service->list(10).studies, IsEmpty());
}

}  // namespace
}  // namespace steerstat::testing
