#include "store/result_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <thread>
#include <tuple>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "sample_result.hpp"
#include "study/spec_json.hpp"
#include "study/subset_simulation.hpp"
#include "trial/trial.hpp"

namespace steerstat {
namespace {

using namespace testing_store;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

/// Expects the two results to hold the same trials, bit for bit.
void expect_same_trials(const StudyResult& a, const StudyResult& b) {
  EXPECT_EQ(a.trials.index, b.trials.index);
  ASSERT_EQ(a.trials.outcomes.size(), b.trials.outcomes.size());
  for (std::size_t row = 0; row < a.trials.outcomes.size(); ++row) {
    EXPECT_TRUE(same_bits(a.trials.outcomes[row], b.trials.outcomes[row])) << "row " << row;
  }
  EXPECT_EQ(a.complete, b.complete);
  EXPECT_EQ(a.wall_s, b.wall_s);
  EXPECT_EQ(a.threads, b.threads);
  EXPECT_EQ(a.simd, b.simd);
  EXPECT_EQ(a.audit.tolerance, b.audit.tolerance);
  ASSERT_EQ(a.audit.trials.size(), b.audit.trials.size());
  for (std::size_t row = 0; row < a.audit.trials.size(); ++row) {
    const AuditedTrial& x = a.audit.trials[row];
    const AuditedTrial& y = b.audit.trials[row];
    EXPECT_EQ(std::tie(x.index, x.status, x.cycles, x.swings), std::tie(y.index, y.status, y.cycles, y.swings));
    EXPECT_TRUE(x.settling_time == y.settling_time || (std::isnan(x.settling_time) && std::isnan(y.settling_time)));
  }
}

class ResultFile : public testing::Test {
 protected:
  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "result.h5";
};

TEST_F(ResultFile, ReadsBackTheSameBits) {
  const Study study = sample_study(200);
  const StudyResult result = made_up_result(study);
  write_result(path_, study, result);
  const StoredStudy stored = read_result(path_);
  EXPECT_EQ(stored.study, study);
  EXPECT_EQ(stored.engine_version, engine_version());
  EXPECT_THAT(stored.created, MatchesRegex("20..-..-..T..:..:..Z"));
  expect_same_trials(stored.result, result);
}

TEST_F(ResultFile, HasTheTrialsOfASubsetSimulationWhichItsSpecAloneHasNot) {
  const Study study = decode_study(
      R"({"plant": {"f2": {"uniform": [0, 0.03]}}, "metrics": false, "audit": {"trials": 2},
          "sampling": {"method": "subset_simulation", "trials": 100}})",
      {});
  SubsetRun run = run_subset_simulation(study, {});
  write_result(path_, run.study, run.result);
  const StoredStudy stored = read_result(path_);
  EXPECT_EQ(stored.study, run.study);
  expect_same_trials(stored.result, run.result);

  run.result.trials.outcomes.pop_back();
  run.result.trials.index.pop_back();
  EXPECT_THROW(write_result(path_, run.study, run.result), std::invalid_argument);
}

TEST_F(ResultFile, KeepsWhatItRanOnAndSaysNoneOfTheReference) {
  StudyResult result = made_up_result(sample_study(5));
  for (const std::optional<InstructionSet> set :
       {std::optional(InstructionSet::avx512), std::optional(InstructionSet::portable), {}}) {
    result.simd = set;
    write_result(path_, sample_study(5), result);
    EXPECT_EQ(read_result(path_).result.simd, set);
  }
}

TEST_F(ResultFile, HoldsTheDrawsOfEveryTrial) {
  const Study study = sample_study(50);
  write_result(path_, study, made_up_result(study));
  const StoredStudy stored = read_result(path_);
  const Plan plan(study);
  ASSERT_EQ(stored.parameters.size(), plan.varying().size());
  std::vector<double> values(plan.varying().size());
  for (std::uint64_t index = 0; index < plan.trials(); ++index) {
    plan.draw(index, values);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(stored.parameters[i][index], values[i]);
  }
}

TEST_F(ResultFile, HoldsOneTrialWithoutVaryingInputs) {
  const Study study = decode_study("{}", {});
  const StudyResult result = made_up_result(study);
  write_result(path_, study, result);
  const StoredStudy stored = read_result(path_);
  EXPECT_TRUE(stored.parameters.empty());
  expect_same_trials(stored.result, result);
}

TEST_F(ResultFile, HoldsMoreTrialsThanAChunk) {
  const Study study = sample_study(22000);  // 66,000 rows, chunks of 65,536
  const StudyResult result = made_up_result(study);
  write_result(path_, study, result);
  expect_same_trials(read_result(path_).result, result);
}

TEST_F(ResultFile, KeepsTheRowsOfAnInterruptedRunWithTheirGaps) {
  const Study study = sample_study(100);
  StudyResult result = made_up_result(study);
  result.complete = false;
  result.trials.index.erase(result.trials.index.begin() + 40, result.trials.index.begin() + 90);
  result.trials.outcomes.erase(result.trials.outcomes.begin() + 40, result.trials.outcomes.begin() + 90);
  write_result(path_, study, result);
  const StoredStudy stored = read_result(path_);
  expect_same_trials(stored.result, result);
  const Plan plan(study);
  std::vector<double> values(plan.varying().size());
  plan.draw(90, values);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(stored.parameters[i][40], values[i]);
}

TEST_F(ResultFile, KeepsARunInterruptedBeforeItsFirstTrial) {
  const Study study = sample_study(100);
  StudyResult result;
  result.threads = 1;
  write_result(path_, study, result);
  const StoredStudy stored = read_result(path_);
  expect_same_trials(stored.result, result);
  for (const std::vector<double>& column : stored.parameters) EXPECT_TRUE(column.empty());
}

TEST_F(ResultFile, IsTheSameBytesForTheSameResultButForWhenItWasCreated) {
  const Study study = sample_study(100);
  const StudyResult result = made_up_result(study);
  const auto other = directory_.path() / "other.h5";
  // The clock may pass a second in between; two tries in a row cannot both be hit within a test's time.
  bool same = false;
  for (int attempt = 0; attempt < 5 && !same; ++attempt) {
    write_result(path_, study, result);
    write_result(other, study, result);
    same = read_result(path_).created == read_result(other).created;
  }
  ASSERT_TRUE(same);
  EXPECT_EQ(bytes_of(path_), bytes_of(other));
}

TEST_F(ResultFile, ReplacesAnOlderOneAndLeavesNothingElseBehind) {
  write_result(path_, sample_study(10), made_up_result(sample_study(10)));
  write_result(path_, sample_study(20), made_up_result(sample_study(20)));
  EXPECT_EQ(read_result(path_).study, sample_study(20));
  EXPECT_EQ(entries_in(directory_.path()), 1U);
}

TEST_F(ResultFile, IsNamedWhenItCannotBeWritten) {
  const auto nowhere = directory_.path() / "missing" / "result.h5";
  try {
    write_result(nowhere, sample_study(1), made_up_result(sample_study(1)));
    FAIL() << "wrote into a directory that does not exist";
  } catch (const RunFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr(nowhere.string()));
    EXPECT_THAT(failure.what(), HasSubstr("No such file or directory"));
  }
}

TEST_F(ResultFile, IsWrittenAndReadByManyThreadsAtOnce) {
  const Study study = sample_study(300);
  std::vector<std::thread> threads;
  std::vector<int> same(8, 0);
  for (unsigned i = 0; i < same.size(); ++i) {
    threads.emplace_back([&, i] {
      const auto path = directory_.path() / std::to_string(i);
      const StudyResult result = made_up_result(study, i);
      write_result(path, study, result);
      const StoredStudy stored = read_result(path);
      same[i] = std::equal(result.trials.outcomes.begin(), result.trials.outcomes.end(),
                           stored.result.trials.outcomes.begin(), stored.result.trials.outcomes.end(), same_bits);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(same, std::vector<int>(8, 1));
}

}  // namespace
}  // namespace steerstat
