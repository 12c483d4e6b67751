#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "control/phase.hpp"
#include "json_text.hpp"
#include "process.hpp"
#include "store/result_file.hpp"
#include "study/plan.hpp"

namespace steerstat::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

using Rows = std::vector<std::vector<std::string>>;

Rows parse_csv(const std::string& text) {
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string>& cells = rows.emplace_back();
    std::istringstream row(line + ",");
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  }
  return rows;
}

double number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_TRUE(error == std::errc() && end == text.data() + text.size()) << text;
  return value;
}

/// A result file of six perturbed trials, some of which converge.
class Replay : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string spec = scratch_.file("spec.json", R"({"plant": {"f2": {"uniform": [0, 0.05]}},
        "initial_state": {"q1": {"uniform": [-1, 1]}}, "controller": {"contraction": {"eta1": {"sweep": [0.4, 0.5]}}},
        "integrator": {"method": "cvode"}, "horizon": 150, "sampling": {"trials": 3}})");
    const Ending run = steerstat({"run", spec, "-o", file_});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    stored_ = read_result(file_);
    ASSERT_EQ(stored_.result.trials.index.size(), 6U);
  }

  Scratch scratch_;
  std::string file_{scratch_ / "out.h5"};
  StoredStudy stored_;
};

TEST_F(Replay, EveryTrialEndsInTheStoredBits) {
  for (std::size_t trial = 0; trial < 6; ++trial) {
    const Ending replay = steerstat({"replay", file_, "--trial", std::to_string(trial)});
    ASSERT_EQ(replay.exit_code, 0) << replay.err;
    const Rows rows = parse_csv(replay.out);
    EXPECT_THAT(rows.front(), ElementsAre("t", "q1", "q2", "q1_dot", "q2_dot", "a", "tau", "phase"));
    const TrialOutcome& end = stored_.result.trials.outcomes[trial];
    EXPECT_EQ(number(rows.back()[0]), end.end_time);
    EXPECT_EQ(
        (State<double>{number(rows.back()[1]), number(rows.back()[2]), number(rows.back()[3]), number(rows.back()[4])}),
        end.end_state);
    EXPECT_EQ(rows[1][0], "0");
    EXPECT_EQ(number(rows[1][1]), Plan(stored_.study).parameters(trial).start.q1);
    for (std::size_t row = 1; row < rows.size(); ++row) {
      ASSERT_EQ(rows[row].size(), 8U);
      EXPECT_NE(std::find(phase_names.begin(), phase_names.end(), rows[row][7]), phase_names.end());
      EXPECT_GE(number(rows[row][0]), row > 1 ? number(rows[row - 1][0]) : 0.0);
    }
  }
}

TEST_F(Replay, JsonAndCsvHoldTheSameNumbers) {
  ASSERT_EQ(steerstat({"replay", file_, "--trial", "3", "-o", scratch_ / "3.json"}).exit_code, 0);
  ASSERT_EQ(steerstat({"replay", file_, "--trial", "3", "-o", scratch_ / "3.csv"}).exit_code, 0);
  const Rows rows = parse_csv(read_file(scratch_ / "3.csv"));
  const Json json = json_of(read_file(scratch_ / "3.json"));
  for (std::size_t column = 0; column < 8; ++column) {
    const Json& values = json.at("trajectory").at(rows[0][column]);
    ASSERT_EQ(values.size(), rows.size() - 1);
    for (std::size_t row = 1; row < rows.size(); ++row) {
      if (column == 7) {
        EXPECT_EQ(values[row - 1], rows[row][7]);
      } else {
        EXPECT_EQ(values[row - 1], number(rows[row][column]));
      }
    }
  }
  EXPECT_EQ(json.at("index"), 3);
  EXPECT_EQ(json.at("outcome").at("end_time"), stored_.result.trials.outcomes[3].end_time);
  EXPECT_EQ(json.at("parameters").at("controller.contraction.eta1"), 0.5);
  EXPECT_EQ(read_file(scratch_ / "3.csv"), steerstat({"replay", file_, "--trial", "3"}).out);
}

TEST_F(Replay, ATrialThatIsNotThereExitsWithTwoAndNamesThoseThatAre) {
  for (const char* trial : {"6", "-1", "1.5", "one", "", "99999999999999999999"}) {
    const Ending replay = steerstat({"replay", file_, "--trial", trial, "-o", scratch_ / "out.csv"});
    EXPECT_EQ(replay.exit_code, 2) << trial;
    EXPECT_THAT(replay.err, HasSubstr("0 to 5"));
  }
  EXPECT_THAT(scratch_.names(), ElementsAre("out.h5", "spec.json"));
}

TEST_F(Replay, NeedsTheResultFileAlone) {
  scratch_.file("trials.csv", "plant.m1\n1.1\n0.9\n");
  const std::string spec =
      scratch_.file("explicit.json", R"({"horizon": 30, "sampling": {"method": "explicit", "file": "trials.csv"}})");
  ASSERT_EQ(steerstat({"run", spec, "-o", scratch_ / "explicit.h5"}).exit_code, 0);
  std::filesystem::remove(scratch_ / "trials.csv");
  std::filesystem::remove(spec);
  const Ending replay = steerstat({"replay", scratch_ / "explicit.h5", "--trial", "1"});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_EQ(number(parse_csv(replay.out).back()[0]),
            read_result(scratch_ / "explicit.h5").result.trials.outcomes[1].end_time);
}

TEST_F(Replay, AnEndOtherThanTheStoredOneExitsWithFourAndWritesNothing) {
  StudyResult changed = stored_.result;
  double& q2 = changed.trials.outcomes[2].end_state.q2;
  q2 = std::nextafter(q2, 10.0);
  write_result(scratch_ / "changed.h5", stored_.study, changed);
  const Ending replay = steerstat({"replay", scratch_ / "changed.h5", "--trial", "2", "-o", scratch_ / "2.csv"});
  EXPECT_EQ(replay.exit_code, 4);
  EXPECT_THAT(replay.err, HasSubstr("trial 2"));
  EXPECT_EQ(replay.out, "");
  EXPECT_THAT(scratch_.names(), ElementsAre("changed.h5", "out.h5", "spec.json"));
  EXPECT_EQ(steerstat({"replay", scratch_ / "changed.h5", "--trial", "1"}).exit_code, 0);
}

TEST_F(Replay, AnEndWithAnotherMetricIsAnotherEndButOneWithoutMetricsIsNot) {
  StudyResult older = stored_.result;
  for (TrialOutcome& outcome : older.trials.outcomes) {
    outcome.effort = outcome.peak_acceleration = outcome.peak_force = outcome.peak_stroke = no_value;
    outcome.position_contraction = outcome.velocity_contraction = {};
  }
  write_result(scratch_ / "older.h5", stored_.study, older);
  EXPECT_EQ(steerstat({"replay", scratch_ / "older.h5", "--trial", "2"}).exit_code, 0);
  StudyResult changed = stored_.result;
  double& ratio = changed.trials.outcomes[2].position_contraction.mean;
  ASSERT_FALSE(std::isnan(ratio));
  ratio = std::nextafter(ratio, 10.0);
  write_result(scratch_ / "changed.h5", stored_.study, changed);
  EXPECT_EQ(steerstat({"replay", scratch_ / "changed.h5", "--trial", "2"}).exit_code, 4);
}

TEST_F(Replay, ExportHoldsEveryTrialToTheBit) {
  ASSERT_EQ(steerstat({"export", file_, "-o", scratch_ / "out.csv"}).exit_code, 0);
  const Rows rows = parse_csv(read_file(scratch_ / "out.csv"));
  EXPECT_THAT(rows[0],
              ElementsAre("index", "cell", "plant.f2", "initial_state.q1", "controller.contraction.eta1", "status",
                          "settling_time", "end_time", "cycles", "swings", "alignments", "passive_error",
                          "active_error", "q1", "q2", "q1_dot", "q2_dot", "effort", "peak_acceleration", "peak_force",
                          "peak_stroke", "position_contraction_mean", "position_contraction_worst",
                          "velocity_contraction_mean", "velocity_contraction_worst"));
  ASSERT_EQ(rows.size(), 7U);
  for (std::size_t trial = 0; trial < 6; ++trial) {
    const std::vector<std::string>& row = rows[trial + 1];
    ASSERT_EQ(row.size(), rows[0].size());
    EXPECT_EQ(row[0], std::to_string(trial));
    EXPECT_EQ(row[1], std::to_string(trial % 2));
    const Plan plan(stored_.study);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string& name = rows[0][2 + i];
      const auto place = std::find(plan.varying().begin(), plan.varying().end(), name) - plan.varying().begin();
      EXPECT_EQ(number(row[2 + i]), stored_.parameters[static_cast<std::size_t>(place)][trial]);
    }
    const TrialOutcome& stored = stored_.result.trials.outcomes[trial];
    TrialOutcome exported;
    exported.status = status_named(row[5]).value();
    if (exported.status == Status::converged) {
      EXPECT_EQ(row[6], row[7]);
    } else {
      EXPECT_EQ(row[6], "");
    }
    exported.end_time = number(row[7]);
    exported.cycles = static_cast<std::uint32_t>(std::stoul(row[8]));
    exported.swings = static_cast<std::uint32_t>(std::stoul(row[9]));
    exported.alignments = static_cast<std::uint32_t>(std::stoul(row[10]));
    exported.passive_error = number(row[11]);
    exported.active_error = number(row[12]);
    exported.end_state = {number(row[13]), number(row[14]), number(row[15]), number(row[16])};
    const auto metric = [&](std::size_t column) { return row[column].empty() ? no_value : number(row[column]); };
    exported.effort = metric(17);
    exported.peak_acceleration = metric(18);
    exported.peak_force = metric(19);
    exported.peak_stroke = metric(20);
    exported.position_contraction = {metric(21), metric(22)};
    exported.velocity_contraction = {metric(23), metric(24)};
    EXPECT_TRUE(same_bits(exported, stored)) << "trial " << trial;
  }
}

TEST_F(Replay, AnOutputThatCannotBeWrittenExitsWithFour) {
  const std::string place = scratch_ / "absent/out.csv";
  EXPECT_EQ(steerstat({"replay", file_, "--trial", "0", "-o", place}).exit_code, 4);
  EXPECT_EQ(steerstat({"export", file_, "-o", place}).exit_code, 4);
}

}  // namespace
}  // namespace steerstat::testing
