#include "study/audit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <utility>
#include <vector>

#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using ::testing::ElementsAre;

TEST(RowsToAudit, AreAscendingDistinctAndAmongTheFinished) {
  for (const std::uint64_t finished : {17U, 1000U, 1000000U}) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const auto rows = rows_to_audit(seed, 16, finished);
      ASSERT_EQ(rows.size(), 16U);
      EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()), rows.end());
      EXPECT_LT(rows.back(), finished);
    }
  }
}

TEST(RowsToAudit, AreAllWhereNoMoreHaveFinished) {
  EXPECT_THAT(rows_to_audit(1, 3, 3), ElementsAre(0, 1, 2));
  EXPECT_THAT(rows_to_audit(1, 16, 2), ElementsAre(0, 1));
  EXPECT_THAT(rows_to_audit(1, 16, 0), ElementsAre());
  EXPECT_EQ(rows_to_audit(1, 3, 4).size(), 3U);
}

TEST(RowsToAudit, AreNoneWhereNoneAreWanted) {
  EXPECT_THAT(rows_to_audit(1, 0, 1000), ElementsAre());
}

TEST(RowsToAudit, DependOnTheSeedAlone) {
  EXPECT_EQ(rows_to_audit(7, 16, 1000), rows_to_audit(7, 16, 1000));
  EXPECT_NE(rows_to_audit(7, 16, 1000), rows_to_audit(8, 16, 1000));
}

TEST(RowsToAudit, ArePairsOfFiveEachAsOftenAsTheOthers) {
  constexpr int draws = 20000;
  std::map<std::pair<std::uint64_t, std::uint64_t>, int> counts;
  for (int seed = 0; seed < draws; ++seed) {
    const auto rows = rows_to_audit(static_cast<std::uint64_t>(seed), 2, 5);
    ++counts[{rows[0], rows[1]}];
  }
  ASSERT_EQ(counts.size(), 10U);
  const double expected = draws / 10.0;
  for (const auto& [pair, count] : counts) {
    EXPECT_NEAR(count, expected, 4.0 * std::sqrt(expected * 0.9)) << pair.first << ' ' << pair.second;
  }
}

TEST(Auditor, IsSundialsAtAHundredthOfTheToleranceButNotBelowTheLeast) {
  constexpr auto cvode = IntegratorChoice::Method::cvode;
  for (const auto method : {IntegratorChoice::Method::lockstep, cvode}) {
    EXPECT_EQ(auditor_of({method, 1e-9}), (IntegratorChoice{cvode, 1e-9 / 100.0, false}));
    EXPECT_EQ(auditor_of({method, 1e-10}).tolerance, 1e-12);
    EXPECT_EQ(auditor_of({method, 1e-13}).tolerance, 1e-12);
  }
}

TEST(Audited, AgreesOnlyWhereStatusCyclesAndSwingsAreTheSame) {
  TrialOutcome outcome;
  outcome.status = Status::converged;
  outcome.cycles = 9;
  outcome.swings = 2;
  outcome.end_time = 47.25;
  const AuditedTrial same = audited(5, outcome);
  EXPECT_EQ(same.index, 5U);
  EXPECT_EQ(same.settling_time, 47.25);
  EXPECT_TRUE(agree(same, outcome));

  TrialOutcome other_time = outcome;
  other_time.end_time = 48.0;
  other_time.alignments = 3;
  EXPECT_TRUE(agree(same, other_time));

  TrialOutcome wrong_status = outcome;
  wrong_status.status = Status::timeout;
  TrialOutcome wrong_cycles = outcome;
  ++wrong_cycles.cycles;
  TrialOutcome wrong_swings = outcome;
  --wrong_swings.swings;
  for (const TrialOutcome& wrong : {wrong_status, wrong_cycles, wrong_swings}) EXPECT_FALSE(agree(same, wrong));
  EXPECT_TRUE(std::isnan(audited(5, wrong_status).settling_time));
}

// --- the audit of a run ---

Study small_study(std::uint64_t audited_trials) {
  Study study = decode_study(R"({
      "plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
      "initial_state": {"q1": {"uniform": [-1, 1]}, "q2": {"uniform": [-3.1, 3.1]}},
      "horizon": 300, "sampling": {"trials": 300}})",
                             {});
  study.audited_trials = audited_trials;
  return study;
}

RunOptions on_threads(unsigned threads) {
  RunOptions options;
  options.threads = threads;
  return options;
}

std::vector<std::uint64_t> indices_of(const Audit& audit) {
  std::vector<std::uint64_t> indices;
  for (const AuditedTrial& trial : audit.trials) indices.push_back(trial.index);
  return indices;
}

TEST(RunStudysAudit, AgreesWithLockstep) {
  Study study = small_study(60);
  study.integrator.tolerance = 1e-10;
  const StudyResult result = run_study(study, on_threads(2));
  EXPECT_EQ(result.audit.tolerance, 1e-12);
  ASSERT_EQ(result.audit.trials.size(), 60U);
  int converged = 0;
  for (const AuditedTrial& trial : result.audit.trials) {
    const TrialOutcome& outcome = result.trials.outcomes[trial.index];
    EXPECT_TRUE(agree(trial, outcome)) << "trial " << trial.index;
    if (outcome.status != Status::converged) continue;
    ++converged;
    EXPECT_NEAR(trial.settling_time, outcome.settling_time(), 1e-5) << "trial " << trial.index;
  }
  EXPECT_GT(converged, 10);
}

TEST(RunStudysAudit, IsTheSameBitsOnOneTwoAndThreeThreads) {
  const StudyResult one = run_study(small_study(20), on_threads(1));
  EXPECT_EQ(indices_of(one.audit), rows_to_audit(1, 20, 300));
  for (const unsigned threads : {2U, 3U}) {
    const StudyResult other = run_study(small_study(20), on_threads(threads));
    ASSERT_EQ(indices_of(other.audit), indices_of(one.audit));
    for (std::size_t i = 0; i < one.audit.trials.size(); ++i) {
      const AuditedTrial& a = one.audit.trials[i];
      const AuditedTrial& b = other.audit.trials[i];
      EXPECT_EQ(a.status, b.status);
      EXPECT_EQ(a.cycles, b.cycles);
      EXPECT_EQ(a.swings, b.swings);
      EXPECT_TRUE(a.settling_time == b.settling_time || (std::isnan(a.settling_time) && std::isnan(b.settling_time)));
    }
  }
}

/// Runs trials on an engine and tells one cycle too many of a single trial.
class LyingRunner final : public TrialRunner {
 public:
  LyingRunner(std::unique_ptr<TrialRunner> engine, std::uint64_t victim)
      : engine_(std::move(engine)), victim_(victim) {}

  using TrialRunner::run;
  void run(TrialStream& stream) override {
    struct Lie final : TrialStream {
      Lie(TrialStream& honest, std::uint64_t chosen) : stream(honest), victim(chosen) {}
      bool next(std::uint64_t& index, TrialParameters& parameters) override { return stream.next(index, parameters); }
      void finished(std::uint64_t index, const TrialOutcome& outcome) override {
        TrialOutcome told = outcome;
        told.cycles += index == victim ? 1 : 0;
        stream.finished(index, told);
      }
      TrialStream& stream;
      std::uint64_t victim;
    };
    Lie lie(stream, victim_);
    engine_->run(lie);
  }

 private:
  std::unique_ptr<TrialRunner> engine_;
  std::uint64_t victim_;
};

TEST(RunStudysAudit, FindsTheOneOutcomeThatIsWrong) {
  const std::uint64_t victim = rows_to_audit(1, 10, 300)[4];
  RunOptions options = on_threads(2);
  options.make_runner = [&](const IntegratorChoice& integrator) {
    return std::make_unique<LyingRunner>(make_runner(integrator), victim);
  };
  const StudyResult result = run_study(small_study(10), options);
  ASSERT_EQ(result.audit.trials.size(), 10U);
  for (const AuditedTrial& trial : result.audit.trials) {
    EXPECT_EQ(agree(trial, result.trials.outcomes[trial.index]), trial.index != victim) << "trial " << trial.index;
  }
}

TEST(RunStudysAudit, IsOfAllTrialsWhereThereAreFew) {
  Study study = small_study(16);
  study.sampling.trials = 3;
  EXPECT_THAT(indices_of(run_study(study, on_threads(2)).audit), ElementsAre(0, 1, 2));
}

TEST(RunStudysAudit, IsEmptyWhereNoneIsAskedFor) {
  EXPECT_TRUE(run_study(small_study(0), on_threads(2)).audit.trials.empty());
}

TEST(RunStudysAudit, DoesNotBeginAfterAStop) {
  std::stop_source stop;
  RunOptions options = on_threads(1);
  options.stop = stop.get_token();
  options.on_progress = [&](const Progress& progress) {
    if (progress.completed == progress.requested) stop.request_stop();
  };
  const StudyResult result = run_study(small_study(16), options);
  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.audit.trials.empty());
}

}  // namespace
}  // namespace steerstat
