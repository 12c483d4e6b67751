#include "core/errors.hpp"
#include "service/study_demand.hpp"
#include "service_fixture.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;

class Sharing : public ServiceCase {
 protected:
  /// The pointers of the mistakes for which a spec is refused.
  template <class Refusal>
  std::vector<std::string> refused(const std::string& spec) {
    std::vector<std::string> pointers;
    try {
      service->submit(spec);
      ADD_FAILURE() << "it was taken: " << spec;
    } catch (const Refusal& refusal) {
      for (const SpecError& error : refusal.errors()) pointers.push_back(error.pointer);
    }
    EXPECT_TRUE(service->list(1).studies.empty()) << "a refused spec leaves nothing";
    return pointers;
  }
};

TEST_F(Sharing, AThousandTrialsBehindAMillionAreDoneWhileThoseAreFarFromIt) {
  const std::string big = service->submit(long_spec()).state.id;
  wait_for_kept_trials(big);
  const std::uint64_t before = service->state(big)->completed;
  const std::string small = service->submit(quick_spec(1000)).state.id;
  wait_for(small, StudyStatus::succeeded);
  // What is reported is up to 200 ms behind.
  const StudyState after = wait_until(big, [&](const StudyState& state) { return state.completed > before; });
  EXPECT_EQ(after.status, StudyStatus::running);
  EXPECT_GT(after.completed, before) << "both go on";
  EXPECT_LT(after.completed, after.requested / 2);
  expect_undisturbed(small, quick_spec(1000));
}

TEST_F(Sharing, TwoStudiesOfEqualTrialsComeForwardAlike) {
  const std::string a = service->submit(long_spec(1)).state.id;
  wait_for(a, StudyStatus::running);
  const std::string b = service->submit(long_spec(2)).state.id;
  wait_for_kept_trials(b);
  const std::uint64_t a_before = service->state(a)->completed;
  const std::uint64_t b_before = service->state(b)->completed;
  const StudyState b_after =
      wait_until(b, [&](const StudyState& state) { return state.completed >= b_before + 40'000; });
  const auto ratio =
      static_cast<double>(service->state(a)->completed - a_before) / static_cast<double>(b_after.completed - b_before);
  // Turns alternate and trials are alike: half each, but for the moments at which the two were looked at.
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2.0);
}

TEST_F(Sharing, ACancelledStudyBeginsNoFurtherBlock) {
  const std::string id = service->submit(long_spec()).state.id;
  wait_for_kept_trials(id);
  const std::uint64_t before = service->state(id)->completed;
  const StudyState after = service->cancel_or_remove(id).state;
  EXPECT_EQ(after.status, StudyStatus::cancelled);
  EXPECT_GE(after.completed, before);
  // The state is told a few times a second, so it may be behind by that much.
  EXPECT_LT(after.completed, before + 200'000);
  EXPECT_EQ(after.completed % 128, 0U) << "whole blocks are kept";
}

TEST_F(Sharing, TrialsThatTakeMinutesHoldNoOtherStudyUp) {
  service.reset();
  limits.stopping_time = std::chrono::milliseconds(0);
  begin();
  const std::string endless = service->submit(endless_spec()).state.id;
  wait_for_work(endless);
  const std::string small = service->submit(quick_spec(1000)).state.id;
  wait_for(small, StudyStatus::succeeded);
  EXPECT_EQ(service->state(endless)->status, StudyStatus::running);
  EXPECT_EQ(service->state(endless)->completed, 0U);
}

TEST_F(Sharing, TrialsThatTakeMinutesAreGivenUpWhenTheirStudyIsCancelledAndItCanGoOn) {
  service.reset();
  limits.ending_time = limits.stopping_time = std::chrono::milliseconds(0);
  limits.cancelling_time = std::chrono::minutes(10);
  begin();
  const std::string id = service->submit(endless_spec()).state.id;
  wait_for_work(id);
  EXPECT_EQ(service->cancel_or_remove(id).state.status, StudyStatus::cancelled);
  EXPECT_FALSE(service->submit(endless_spec()).created);
  wait_for_work(id);
  restart();
  wait_for_work(id);
  EXPECT_EQ(service->cancel_or_remove(id).state.status, StudyStatus::cancelled);
  EXPECT_TRUE(service->cancel_or_remove(id).removed);
}

TEST_F(Sharing, ATrialThatAClientWaitsForMayNotTakeMinutes) {
  const auto check_in = within(std::chrono::milliseconds(0));
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_THROW(check_in(), TakesTooLong);
  EXPECT_NO_THROW(within(std::chrono::minutes(10))());
}

TEST_F(Sharing, TheSummaryOfARunningStudyIsOfAPrefixThatGrows) {
  const std::string id = service->submit(long_spec()).state.id;
  wait_for_kept_trials(id);
  const SummaryText first = service->summary(id);
  EXPECT_FALSE(first.complete);
  EXPECT_THAT(first.json, HasSubstr("\"complete\": false"));
  EXPECT_EQ(service->summary(id).json, first.json) << "it is not made anew each time";
  const TrialPage page = service->trials(id, {}, 0, 10);
  ASSERT_EQ(page.rows.size(), 10U);
  EXPECT_EQ(page.names.size(), 3U);
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (service->summary(id).json == first.json && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_NE(service->summary(id).json, first.json);
  EXPECT_EQ(service->trials(id, {}, 0, 10).rows[9].outcome, page.rows[9].outcome) << "what is told stays";
  EXPECT_FALSE(service->result_file(id));
  const ReplayedTrial replayed = service->trajectory(id, 7);
  EXPECT_EQ(replayed.trajectory.outcome, page.rows[7].outcome);
}

TEST_F(Sharing, AStudyThatRunsTooLongFailsAndKeepsItsTrials) {
  service.reset();
  limits.wall_time = std::chrono::seconds(3);
  begin();
  const std::string id = service->submit(long_spec()).state.id;
  const StudyState state = wait_for_end(id);
  EXPECT_EQ(state.status, StudyStatus::failed);
  EXPECT_THAT(state.failure.value_or(""), HasSubstr("it ran for 3.0 s, as long as a study may"));
  EXPECT_GT(state.completed, 0U);
  EXPECT_EQ(service->trials(id, {}, 0, 10).rows.size(), 10U);
  EXPECT_FALSE(service->submit(long_spec()).created);
  EXPECT_FALSE(is_over(service->state(id)->status)) << "submitted again, it goes on";
}

TEST_F(Sharing, ABoundedQueueSaysWhenToComeAgain) {
  service.reset();
  limits.running_studies = 1;
  limits.queued_studies = 2;
  begin();
  wait_for(service->submit(long_spec()).state.id, StudyStatus::running);
  const std::string first = service->submit(quick_spec(10)).state.id;
  service->submit(quick_spec(11));
  try {
    service->submit(quick_spec(12));
    FAIL() << "there is no place for it";
  } catch (const QueueFull& refusal) {
    EXPECT_GT(refusal.retry_after(), 0U);
  }
  EXPECT_FALSE(service->submit(quick_spec(11)).created) << "one that waits already needs no place";
  service->cancel_or_remove(first);
  EXPECT_TRUE(service->submit(quick_spec(12)).created);
}

TEST_F(Sharing, ASpecThatNamesAFileIsRefused) {
  EXPECT_THAT(refused<BadSpec>(R"({"sampling": {"method": "explicit", "file": "/etc/passwd"}})"),
              ::testing::ElementsAre("/sampling/file"));
}

TEST_F(Sharing, AnApproximationStudyIsRefused) {
  EXPECT_THAT(refused<BadSpec>(R"({"kind": "approximation"})"), ::testing::ElementsAre("/kind"));
}

TEST_F(Sharing, ASubsetSimulationIsRefused) {
  EXPECT_THAT(refused<LimitExceeded>(R"({"plant": {"f2": {"uniform": [0, 0.05]}}, "audit": {"trials": 0},
                  "sampling": {"method": "subset_simulation", "trials": 100}})"),
              ::testing::ElementsAre("/sampling/method"));
}

TEST_F(Sharing, AStudyBeyondALimitIsRefusedAndOneAtTheLimitIsTaken) {
  service.reset();
  limits.trials = 100;
  limits.cells = 2;
  limits.spec_bytes = 200;
  limits.horizon = 300;
  begin();
  EXPECT_THAT(refused<LimitExceeded>(R"({"sampling": {"trials": 101}})"), ::testing::ElementsAre("/sampling/trials"));
  EXPECT_THAT(refused<LimitExceeded>(R"({"horizon": 301})"), ::testing::ElementsAre("/horizon"));
  EXPECT_THAT(refused<LimitExceeded>(R"({"plant": {"m1": {"sweep": [1, 2, 3]}}})"), ::testing::ElementsAre(""));
  const std::string small = R"({"sampling": {"trials": 50}, "plant": {"m1": {"sweep": [1, 2]}}, "horizon": 5})";
  EXPECT_THAT(refused<LimitExceeded>(small + std::string(201 - small.size(), ' ')), ::testing::ElementsAre(""));
  EXPECT_TRUE(service->submit(small + std::string(200 - small.size(), ' ')).created);
}

TEST_F(Sharing, AStudyThatNeedsMoreMemoryThanThereIsForAllIsRefused) {
  service.reset();
  limits.memory = demand_of(decode_study(quick_spec(1000), {})).memory;
  begin();
  EXPECT_THAT(refused<LimitExceeded>(quick_spec(1001)), ::testing::ElementsAre("/sampling/trials"));
  EXPECT_TRUE(service->submit(quick_spec(1000)).created);
}

}  // namespace
}  // namespace steerstat::testing
