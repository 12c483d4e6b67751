#include <algorithm>
#include <atomic>

#include "core/errors.hpp"
#include "report/summary.hpp"
#include "service_fixture.hpp"

namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Lifecycle : public ServiceCase {};

TEST_F(Lifecycle, AStudyIsRunToTheBitsOfAnUndisturbedRun) {
  const Submission submission = service->submit(quick_spec(700));
  EXPECT_TRUE(submission.created);
  EXPECT_EQ(submission.state.id, study_id(decode_study(quick_spec(700), {})));
  EXPECT_EQ(submission.state.requested, 700U);
  EXPECT_TRUE(fs::exists(home(submission.state.id) / "study.h5")) << "it is on the disk when submit() returns";
  const StudyState state = wait_for_end(submission.state.id);
  EXPECT_EQ(state.status, StudyStatus::succeeded) << state.failure.value_or("");
  EXPECT_EQ(state.completed, 700U);
  EXPECT_LE(state.created, state.started);
  EXPECT_LE(state.started, state.finished);
  expect_undisturbed(state.id, quick_spec(700));
  EXPECT_EQ(service->counters().trials_done, 700U);
  EXPECT_THAT(told, IsEmpty());
}

TEST_F(Lifecycle, TheSummaryIsThatOfTheResultFileAndOutlivesIt) {
  const std::string id = service->submit(quick_spec(300)).state.id;
  wait_for(id, StudyStatus::succeeded);
  const StoredStudy stored = read_result(service->result_file(id).value());
  const SummaryText text = service->summary(id);
  EXPECT_TRUE(text.complete);
  EXPECT_EQ(text.json, summary_json(summarise(stored.study, stored.result)));
  fs::rename(home(id) / "results.h5", home(id) / "elsewhere");
  EXPECT_EQ(service->summary(id).json, text.json) << "it is kept, not made again";
  fs::rename(home(id) / "elsewhere", home(id) / "results.h5");
  testing_store::set_bytes(home(id) / "summary.json", "{}");
  EXPECT_EQ(service->summary(id).json, text.json) << "one that was changed is not believed";
}

TEST_F(Lifecycle, TheSameSpecIsTheSameStudyHoweverItIsWritten) {
  const Submission first = service->submit(quick_spec(50));
  const Submission second = service->submit(service->spec(first.state.id));
  EXPECT_FALSE(second.created);
  EXPECT_EQ(second.state.id, first.state.id);
  EXPECT_EQ(service->list(10).studies.size(), 1U);
}

TEST_F(Lifecycle, EveryStudyIsThereAfterARestart) {
  const StudyState before = wait_for_end(service->submit(quick_spec(200)).state.id);
  const std::string summary = service->summary(before.id).json;
  restart();
  const StudyState after = service->state(before.id).value();
  EXPECT_EQ(after.status, StudyStatus::succeeded);
  EXPECT_EQ(after.revision, before.revision) << "what a client has of it still holds";
  EXPECT_EQ(after.created, before.created);
  EXPECT_EQ(after.finished, before.finished);
  EXPECT_EQ(after.completed, 200U);
  EXPECT_EQ(service->summary(before.id).json, summary);
  EXPECT_FALSE(service->submit(quick_spec(200)).created);
}

TEST_F(Lifecycle, AStudyStoppedInTheMiddleGoesOnByItselfToTheSameBits) {
  const std::string spec = quick_spec(many_trials);
  const std::string id = service->submit(spec).state.id;
  wait_for_kept_trials(id);
  service.reset();
  EXPECT_FALSE(fs::exists(home(id) / "results.h5")) << "it is meant to be unfinished";
  begin();
  EXPECT_GT(service->state(id)->completed, 0U);
  wait_for(id, StudyStatus::succeeded);
  EXPECT_LT(service->counters().trials_done, many_trials) << "what was finished is not run again";
  expect_undisturbed(id, spec);
}

TEST_F(Lifecycle, AnExtendedStudyRunsOnlyWhatIsNew) {
  const std::string shorter = service->submit(quick_spec(300)).state.id;
  wait_for(shorter, StudyStatus::succeeded);
  const std::uint64_t done = service->counters().trials_done;
  const Submission longer = service->submit(quick_spec(700));
  EXPECT_TRUE(longer.created);
  service->cancel_or_remove(shorter);  // its trials belong to both
  EXPECT_FALSE(service->state(shorter));
  wait_for(longer.state.id, StudyStatus::succeeded);
  EXPECT_EQ(service->counters().trials_done - done, 400U);
  expect_undisturbed(longer.state.id, quick_spec(700));
}

TEST_F(Lifecycle, AStudyExtendsOneThatIsUnfinishedFromWhatThatHasKept) {
  const std::string shorter = service->submit(quick_spec(many_trials)).state.id;
  wait_for_kept_trials(shorter);
  const std::uint64_t kept = service->cancel_or_remove(shorter).state.completed;
  ASSERT_LT(kept, many_trials);
  const std::uint64_t done = service->counters().trials_done;
  const std::string longer = service->submit(quick_spec(many_trials + 100)).state.id;
  wait_for(longer, StudyStatus::succeeded);
  EXPECT_EQ(service->counters().trials_done - done, many_trials + 100 - kept);
}

TEST_F(Lifecycle, ACancelledStudyKeepsItsTrialsAndGoesOnWhenItIsSubmittedAgain) {
  const std::string spec = quick_spec(many_trials);
  const std::string id = service->submit(spec).state.id;
  wait_for_kept_trials(id);
  const auto [cancelled, removed] = service->cancel_or_remove(id);
  EXPECT_FALSE(removed);
  ASSERT_EQ(cancelled.status, StudyStatus::cancelled);
  ASSERT_GT(cancelled.completed, 0U);
  ASSERT_LT(cancelled.completed, many_trials);
  EXPECT_EQ(service->trials(id, {}, 0, 1'000'000).rows.size(), cancelled.completed);
  EXPECT_THAT(service->summary(id).json, HasSubstr("\"complete\": false"));
  const StoredStudy partial = read_result(service->result_file(id).value());
  EXPECT_FALSE(partial.result.complete);
  EXPECT_EQ(partial.result.trials.index.size(), cancelled.completed);
  restart();
  EXPECT_EQ(service->state(id)->status, StudyStatus::cancelled) << "a restart does not make it go on";
  EXPECT_EQ(service->trials(id, {}, 0, 1'000'000).rows.size(), cancelled.completed);
  EXPECT_FALSE(service->submit(spec).created);
  wait_for(id, StudyStatus::succeeded);
  EXPECT_EQ(service->counters().trials_done, many_trials - cancelled.completed);
  expect_undisturbed(id, spec);
}

TEST_F(Lifecycle, CancellingAStudyWhoseTrialsTakeLongHoldsNobodyElseUp) {
  const std::string id = service->submit(slow_spec()).state.id;
  wait_for_work(id);
  std::atomic<bool> over{false};
  std::jthread canceller([&] {
    const StudyState state = service->cancel_or_remove(id).state;
    EXPECT_EQ(state.status, StudyStatus::cancelled);
    EXPECT_GE(state.completed, 16U) << "the blocks in flight were waited for";
    over = true;
  });
  unsigned others = 0;  // answered meanwhile; if one had to wait for the other, one at most
  while (!over) {
    service->submit(quick_spec(10));
    if (!over) ++others;
  }
  EXPECT_GE(others, 3U);
}

TEST_F(Lifecycle, ACancelledStudyThatStillRunsIsSaidToRunAndIsCancelledInTheEnd) {
  service.reset();
  limits.cancelling_time = std::chrono::milliseconds(0);
  begin();
  const std::string id = service->submit(slow_spec()).state.id;
  wait_for_work(id);
  const auto [state, removed] = service->cancel_or_remove(id);
  EXPECT_FALSE(removed);
  EXPECT_EQ(state.status, StudyStatus::running);
  EXPECT_THAT(testing_store::bytes_of(home(id) / "state.json"), HasSubstr("cancelled")) << "whatever comes in between";
  EXPECT_THROW(service->submit(slow_spec()), QueueFull) << "it cannot go on before it has ended";
  service->submit(quick_spec(10));
  EXPECT_EQ(wait_for_end(id).status, StudyStatus::cancelled);
  EXPECT_FALSE(service->submit(slow_spec()).created);
  wait_for(id, StudyStatus::running);
  service->cancel_or_remove(id);
}

TEST_F(Lifecycle, APageOfAFinishedStudyIsReadFromItsMiddle) {
  const std::string spec = quick_spec(70'000);
  const std::string id = service->submit(spec).state.id;
  wait_for(id, StudyStatus::succeeded);
  const StoredStudy stored = read_result(service->result_file(id).value());
  const std::vector<TrialOutcome>& outcomes = stored.result.trials.outcomes;
  const TrialPage page = service->trials(id, {}, 65'530, 10);
  ASSERT_EQ(page.rows.size(), 10U);
  EXPECT_EQ(page.next, 65'540U);
  for (std::size_t row = 0; row < 10; ++row) {
    EXPECT_EQ(page.rows[row].index, 65'530 + row);
    EXPECT_EQ(page.rows[row].outcome, outcomes[65'530 + row]);
  }
  EXPECT_EQ(service->trials(id, {}, 69'999, 10).rows.size(), 1U);
  EXPECT_FALSE(service->trials(id, {}, 69'999, 10).next);
  EXPECT_THAT(service->trials(id, {}, 70'000, 10).rows, IsEmpty());
  const Status status = outcomes[65'536].status;
  std::size_t checked = 0;
  for (std::uint64_t begin = 0; const TrialRow& row : service->trials(id, {status, {}}, begin, 80'000).rows) {
    while (outcomes[begin].status != status) ++begin;
    ASSERT_EQ(row.index, begin++);
    ++checked;
  }
  EXPECT_EQ(checked, static_cast<std::size_t>(std::count_if(outcomes.begin(), outcomes.end(),
                                                            [&](const auto& one) { return one.status == status; })));
  std::string bytes = testing_store::bytes_of(home(id) / "results.h5");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  testing_store::set_bytes(home(id) / "results.h5", bytes);
  EXPECT_THROW(static_cast<void>(service->trials(id, {}, 0, 10)), RunFailure) << "it has changed since it was checked";
}

TEST_F(Lifecycle, AStudyThatIsOverIsRemovedFromTheDisk) {
  const std::string id = wait_for_end(service->submit(quick_spec(100)).state.id).id;
  EXPECT_TRUE(service->cancel_or_remove(id).removed);
  EXPECT_FALSE(service->state(id));
  EXPECT_THROW((void)service->summary(id), NoSuchStudy);
  EXPECT_EQ(testing_store::entries_in(data / "studies"), 0U);
  EXPECT_THROW(service->cancel_or_remove(id), NoSuchStudy);
  EXPECT_TRUE(service->submit(quick_spec(100)).created);
}

TEST_F(Lifecycle, AStudyThatWaitsIsCancelledToo) {
  service.reset();
  limits.running_studies = 1;
  begin();
  const std::string running = service->submit(long_spec()).state.id;
  const std::string waiting = service->submit(quick_spec(100)).state.id;
  wait_for(running, StudyStatus::running);
  EXPECT_EQ(service->state(waiting)->status, StudyStatus::queued);
  EXPECT_EQ(service->cancel_or_remove(waiting).state.status, StudyStatus::cancelled);
  EXPECT_EQ(service->counters().studies[static_cast<std::size_t>(StudyStatus::cancelled)], 1U);
  EXPECT_FALSE(service->result_file(waiting));
  EXPECT_THAT(service->trials(waiting, {}, 0, 10).rows, IsEmpty());
}

TEST_F(Lifecycle, StudiesAreListedNewestFirstPageByPage) {
  std::vector<std::string> ids;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    ids.insert(ids.begin(), service->submit(quick_spec(20, seed)).state.id);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // created in different milliseconds
  }
  std::vector<std::string> listed;
  std::string cursor;
  do {
    const StudyPage page = service->list(2, cursor);
    for (const StudyState& state : page.studies) listed.push_back(state.id);
    cursor = page.next.value_or("");
  } while (!cursor.empty());
  EXPECT_EQ(listed, ids);
  EXPECT_THROW((void)service->list(2, "nonsense"), BadUsage);
}

TEST_F(Lifecycle, WhoWaitsForAChangeIsToldOfEachAndOfTheEnd) {
  const StudyState first = service->submit(quick_spec(100)).state;
  StudyState state = first;
  while (!is_over(state.status)) {
    const StudyState next = service->wait_for_change(first.id, state.revision, std::chrono::seconds(60)).value();
    ASSERT_GT(next.revision, state.revision);
    state = next;
  }
  EXPECT_EQ(service->wait_for_change(first.id, state.revision, std::chrono::milliseconds(1))->revision, state.revision);
  EXPECT_FALSE(service->wait_for_change("none", 0, std::chrono::milliseconds(1)));
}

TEST_F(Lifecycle, AServiceThatStopsWakesWhoWaitsAndTakesNoMoreStudies) {
  const StudyState state = service->submit(quick_spec(100)).state;
  const StudyState over = wait_for_end(state.id);
  std::thread stopper([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    service->stop();
  });
  EXPECT_TRUE(service->wait_for_change(state.id, over.revision, std::chrono::minutes(5)));
  stopper.join();
  EXPECT_THROW(service->submit(quick_spec(101)), QueueFull);
  EXPECT_EQ(service->state(state.id)->status, StudyStatus::succeeded) << "readers are still answered";
}

TEST_F(Lifecycle, ASecondServiceInTheSameDirectoryIsRefusedByName) {
  try {
    const StudyService second(data, 1, limits);
    FAIL() << "there are two";
  } catch (const RunFailure& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr(data.string()));
    EXPECT_THAT(refusal.what(), HasSubstr("in use by another process"));
  }
}

}  // namespace
}  // namespace steerstat::testing
