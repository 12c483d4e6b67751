// Studies that do not keep all rows: what they say of all trials must not depend on how these ran.

#include "study/sketched_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>

#include "study/run.hpp"
#include "study/spec_json.hpp"
#include "study/watched.hpp"

namespace steerstat {
namespace {

Study stored_study(const std::string& store, std::uint64_t trials, const std::string& more = "") {
  return decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}}, "horizon": 30,
      "audit": {"trials": 2}, "retain": {"trajectories": {"first": 1, "failed": 2}}, "store": ")" +
                          store + R"(", "sampling": {"trials": )" + std::to_string(trials) + "}" + more + "}",
                      {});
}

StudyResult run(const Study& study, unsigned threads = 1, FinishedTrials earlier = {}) {
  RunOptions options;
  options.threads = threads;
  return run_study(study, options, std::move(earlier));
}

FinishedTrials finished(StudyResult result) {
  return {std::move(result.trials), result.wall_s, std::move(result.sketch)};
}

void expect_same_results(const StudyResult& a, const StudyResult& b) {
  EXPECT_EQ(a.complete, b.complete);
  EXPECT_TRUE(a.sketch == b.sketch);
  EXPECT_EQ(a.trials.index, b.trials.index);
  EXPECT_TRUE(a.trials.outcomes == b.trials.outcomes);
  ASSERT_EQ(a.audit.trials.size(), b.audit.trials.size());
  EXPECT_EQ(a.trajectories.size(), b.trajectories.size());
}

constexpr const char* swept_ratio = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5, 0.7]}}})";

TEST(SketchedRun, CountsAndSumsWhatAllRowsSay) {
  for (const char* more : {"", swept_ratio}) {
    const StudyResult rows = run(stored_study("all", 700, more));
    const StudyResult result = run(stored_study("summary", 700, more));
    EXPECT_TRUE(result.complete);
    ASSERT_EQ(result.finished(), rows.trials.index.size());
    const std::size_t cells = result.sketch->cells().size();
    for (std::size_t cell = 0; cell < cells; ++cell) {
      std::array<std::uint64_t, status_names.size()> outcomes{};
      MetricSketch force;
      for (std::size_t row = cell; row < rows.trials.outcomes.size(); row += cells) {
        ++outcomes[static_cast<std::size_t>(rows.trials.outcomes[row].status)];
        force.add(rows.trials.outcomes[row].peak_force);
      }
      EXPECT_EQ(result.sketch->cells()[cell].outcomes, outcomes);
      EXPECT_EQ(result.sketch->cells()[cell].metrics[metric_index("peak_force")], force);
    }
  }
}

TEST(SketchedRun, KeepsTheRowsThatItsStoreSaysToTheBit) {
  const StudyResult rows = run(stored_study("all", 700));
  const StudyResult none = run(stored_study("summary", 700));
  const StudyResult failed = run(stored_study("failed", 700));
  for (const StudyResult* result : {&none, &failed}) {
    for (std::size_t row = 0; row < result->trials.index.size(); ++row) {
      EXPECT_TRUE(same_bits(result->trials.outcomes[row], rows.trials.outcomes[result->trials.index[row]]));
    }
    EXPECT_EQ(result->trajectories.size(), rows.trajectories.size());
    for (std::size_t i = 0; i < rows.trajectories.size(); ++i) {
      EXPECT_EQ(result->trajectories[i].index, rows.trajectories[i].index);
    }
    EXPECT_EQ(result->audit.trials.size(), 2U);
    EXPECT_EQ(result->audit.trials.front().index, rows.audit.trials.front().index);
  }
  EXPECT_EQ(none.trials.index.size(), 4U) << "the first, which failed, another that failed and two that were audited";
  const auto is_failed = [](const TrialOutcome& outcome) { return outcome.status != Status::converged; };
  const auto failures = std::count_if(rows.trials.outcomes.begin(), rows.trials.outcomes.end(), is_failed);
  ASSERT_GT(failures, 10);
  EXPECT_EQ(std::count_if(failed.trials.outcomes.begin(), failed.trials.outcomes.end(), is_failed), failures);
}

TEST(SketchedRun, IsTheSameOnOneAndThreeThreadsInPiecesAndExtended) {
  const Study study = stored_study("failed", 2000, swept_ratio);
  const StudyResult whole = run(study);
  expect_same_results(run(study, 3), whole);
  FinishedTrials pieces;
  for (const TrialRange range : {TrialRange{3000, 6000}, TrialRange{0, 900}, TrialRange{1200, 3000}}) {
    pieces = joined(std::move(pieces), finished(run_range(study, range, {})));
  }
  EXPECT_EQ(pieces.count(), 5700U);
  expect_same_results(run(study, 2, std::move(pieces)), whole);
  expect_same_results(run(study, 1, finished(run(stored_study("failed", 500, swept_ratio)))), whole);
}

TEST(SketchedRun, StopsWhereARunThatKeepsAllRowsDoes) {
  const std::string rule = R"(, "stop": {"min_trials": 300, "check_every": 130,
                                "until": [{"metric": "success_rate", "half_width": 0.06}]})";
  const Study study = stored_study("summary", 50000, rule);
  const StudyResult rows = run(stored_study("all", 50000, rule));
  const StudyResult result = run(study, 2);
  EXPECT_TRUE(result.complete);
  ASSERT_LT(result.finished(), 5000U);
  EXPECT_EQ(result.finished(), rows.trials.index.size());
  const StopReport report = *watched(study, result);
  EXPECT_EQ(report.reason, StopReason::precision_reached);
  EXPECT_EQ(report.looks, watched(study, rows.trials)->looks);
  EXPECT_EQ(trials_due(study, result), result.finished());
  // On with a part of it, and with a part that no rule can go on with.
  const std::uint64_t part = 128;
  expect_same_results(run(study, 1, finished(run_range(study, {0, part}, {}))), result);
  expect_same_results(run(study, 1, finished(run_range(study, {part, 2 * part}, {}))), result);
}

TEST(SketchedRun, AnInterruptKeepsWholeDrawsAndTheRestRunsLater) {
  const Study study = stored_study("summary", 100000, swept_ratio);
  std::stop_source interrupted;
  RunOptions options;
  options.threads = 1;
  options.stop = interrupted.get_token();
  options.on_progress = [&](const Progress& progress) {
    if (progress.completed > 0) interrupted.request_stop();
  };
  const StudyResult part = run_study(study, options);
  EXPECT_FALSE(part.complete);
  EXPECT_GT(part.finished(), 0U);
  EXPECT_LT(part.finished(), 300000U);
  EXPECT_EQ(part.finished() % 3, 0U);
  EXPECT_TRUE(part.audit.trials.empty());
  const Study small = stored_study("summary", 1000, swept_ratio);
  options.stop = {};
  options.on_progress = {};
  const StudyResult first = run_range(small, {0, 300}, options);
  expect_same_results(run(small, 1, finished(first)), run(small));
}

class Keeper final : public OutcomeSink {
 public:
  void take(std::uint64_t /*begin*/, std::span<const TrialOutcome> /*outcomes*/) override { FAIL() << "rows"; }
  void take_sketched(const FinishedTrials& piece) override { kept = joined(std::move(kept), piece); }
  FinishedTrials kept;
};

TEST(SketchedRun, GivesItsSinkEveryTrialOnce) {
  const Study study = stored_study("failed", 3000);
  Keeper keeper;
  RunOptions options;
  options.sink = &keeper;
  const StudyResult result = run_study(study, options);
  EXPECT_TRUE(keeper.kept.sketch == result.sketch);
  EXPECT_GE(result.trials.index.size(), keeper.kept.trials.index.size());
}

void for_each_in_turn(std::size_t count, const std::function<void(std::size_t)>& task) {
  for (std::size_t i = 0; i < count; ++i) task(i);
}

TEST(SketchedRun, PutsEveryPieceIntoTheSameMemory) {
  const Study study = stored_study("summary", 300000);
  std::set<const TrialOutcome*> places;
  std::uint64_t pieces = 0;
  SketchedRunMeans means;
  means.for_each = for_each_in_turn;
  means.run_piece = [&](TrialRange piece, const RunOptions&, TrialTable room) {
    StudyResult ran;
    ran.trials = std::move(room);
    EXPECT_TRUE(ran.trials.index.empty());
    EXPECT_TRUE(ran.trials.outcomes.empty());
    ran.trials.outcomes.resize(piece.end - piece.begin);
    places.insert(ran.trials.outcomes.data());
    ++pieces;
    return ran;
  };
  StudyResult result;
  result.threads = 1;
  EXPECT_TRUE(run_sketched(study, Plan(study), {0, 300000}, {}, {}, means, result));
  EXPECT_GT(pieces, 2U);
  EXPECT_EQ(places.size(), 1U);
}

TEST(TrialSketch, RefusesTrialsThatItHasAndHalfADraw) {
  const std::vector<TrialOutcome> outcomes(6);
  const ForEach in_turn = for_each_in_turn;
  TrialSketch sketch(3);
  sketch.add(3, outcomes, in_turn);
  EXPECT_THROW(sketch.add(6, outcomes, in_turn), std::invalid_argument);
  EXPECT_THROW(sketch.add(10, outcomes, in_turn), std::invalid_argument);
  EXPECT_THROW(sketch.add(9, std::span(outcomes).first(2), in_turn), std::invalid_argument);
  EXPECT_THROW(sketch.add(sketch), std::invalid_argument);
  sketch.add(9, outcomes, in_turn);
  sketch.add(0, std::span(outcomes).first(3), in_turn);
  EXPECT_EQ(sketch.trials(), (std::vector<TrialRange>{{0, 15}}));
  EXPECT_EQ(sketch.count(), 15U);
}

TEST(FinishedTrials, OfSketchesThatOverlapOneStaysWhole) {
  const Study study = stored_study("failed", 2000);
  const FinishedTrials a = finished(run_range(study, {0, 1000}, {}));
  const FinishedTrials b = finished(run_range(study, {900, 1200}, {}));
  const FinishedTrials c = finished(run_range(study, {100, 300}, {}));
  EXPECT_TRUE(joined(a, b).sketch == a.sketch);
  EXPECT_TRUE(joined(c, a).sketch == a.sketch);
  EXPECT_EQ(joined(c, a).trials.index, a.trials.index);
  EXPECT_EQ(joined(c, b).count(), 500U);
}

}  // namespace
}  // namespace steerstat
