#include "study/spec_json.hpp"
#include "study/approximation_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/errors.hpp"
#include "study/approximation_json.hpp"
#include "study/inputs.hpp"
#include "study/limits.hpp"

namespace steerstat {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

Study study_of(const std::string& spec) {
  return decode_study(spec, {});
}

std::vector<SpecError> errors_of(const std::string& spec) {
  try {
    decode_study(spec, {});
  } catch (const BadSpec& bad) {
    return bad.errors();
  }
  return {};
}

const char* const canonical_empty_spec =
    R"({"audit":{"trials":16},"controller":{"alignment":{"kd":5,"kp":7,"tolerance":0.001},)"
    R"("contraction":{"eta1":0.5,"eta2":0.6,"max_period":30},)"
    R"("convergence":{"active_tolerance":0.02,"tolerance":0.005},"drift":{"min_speed":0},"entry_fraction":0.5,)"
    R"("realignment":"after_cycle","rest_speed":0.001,)"
    R"("swing":{"max_amplitude":200,"min_authority":0.4,"period":2,"speed":0.2}},)"
    R"("goal":{"q1":0,"q2":0.7853981633974483},"horizon":300,)"
    R"("initial_state":{"q1":1,"q1_dot":0,"q2":-0.7853981633974483,"q2_dot":0},)"
    R"("integrator":{"method":"lockstep","tolerance":1e-09},"name":"study",)"
    R"("nominal":{"I2":1,"d2":0.5,"f1":0,"f2":0,"m1":1,"m2":1},"plant":{"I2":1,"d2":0.5,"f1":0,"f2":0,"m1":1,"m2":1},)"
    R"("retain":{"trajectories":{"failed":0,"first":0}},"sampling":{"method":"monte_carlo","seed":1,"trials":1}})";

TEST(CanonicalSpec, MentionsWhatThePolicyReads) {
  const std::string paper = canonical_spec(study_of(R"({"controller": {"policy": "paper", "robust": {"rate": 0.4}}})"));
  EXPECT_EQ(paper, canonical_empty_spec);  // the identity that studies had before there were policies
  const std::string robust = canonical_spec(study_of(R"({"controller": {"policy": "robust"}})"));
  EXPECT_THAT(robust, HasSubstr(R"("controller":{"alignment":{"kd":5,"kp":7,"max_duration":3.5,"tolerance":0.001},)"
                                R"("convergence":{"active_tolerance":0.02,"tolerance":0.005},"policy":"robust",)"
                                R"("robust":{"alignment_time":1.2,"entry_fraction":0.3,"max_acceleration":19,)"
                                R"("period":1.8,"rate":0.4,"travel_speed":0.25,"turning_angle":0.6},)"
                                R"("swing":{"min_authority":0.4}})"));
  EXPECT_THAT(canonical_spec(study_of(R"({"controller": {"max_stroke": 1.5}})")), HasSubstr(R"("max_stroke":1.5,)"));
}

TEST(DecodeStudy, TheEmptySpecHasEveryDefault) {
  const Study study = study_of("{}");
  Study expected;
  expected.inputs = default_inputs({});
  EXPECT_EQ(study, expected);
  EXPECT_EQ(study.name, "study");
  EXPECT_EQ(study.horizon, 300.0);
  EXPECT_EQ(study.integrator, IntegratorChoice{});
  EXPECT_EQ(study.sampling.trials, 1U);
  EXPECT_EQ(study.sampling.seed, 1U);
  EXPECT_EQ(study.retention, Retention{});
  EXPECT_EQ(study.audited_trials, 16U);
}

TEST(DecodeStudy, InputsAreCompleteAndInOrder) {
  const Study study = study_of(R"({"initial_state": {"q2": 1}, "plant": {"f1": 0.1}})");
  std::vector<std::string> names;
  for (const Input& input : study.inputs) names.push_back(input.name);
  EXPECT_EQ(names, input_names());
}

TEST(DecodeStudy, MistakesComeInTheOrderOfTheDocument) {
  const auto errors = errors_of(R"({"sampling": {"seed": -1, "trials": 0}, "zzz": 1, "horizon": 0,
      "goal": {"q2": 0}, "plant": {"I2": 0, "m1": 0}, "name": 1})");
  std::vector<std::string> pointers;
  for (const SpecError& error : errors) pointers.push_back(error.pointer);
  EXPECT_THAT(pointers, ::testing::ElementsAre("/sampling/seed", "/sampling/trials", "/zzz", "/horizon", "/goal/q2",
                                               "/plant/I2", "/plant/m1", "/name"));
}

TEST(DecodeStudy, PointersEscapeTildesAndSlashes) {
  const auto errors = errors_of(R"({"a/b~c": 1})");
  ASSERT_THAT(errors, SizeIs(1));
  EXPECT_EQ(errors[0].pointer, "/a~1b~0c");
}

TEST(DecodeStudy, ReportsAHundredMistakesAndCountsTheRest) {
  std::string spec = R"({"plant": {"m1": {"sweep": [0)";
  for (int i = 0; i < 149; ++i) spec += ",0";
  const auto errors = errors_of(spec + "]}}}");
  ASSERT_THAT(errors, SizeIs(most_errors + 1));
  EXPECT_EQ(errors.back().detail, "and 50 more mistakes; correct these first");
}

TEST(DecodeStudy, MessagesStayShortAndUtf8WhateverTheKey) {
  const auto errors = errors_of("{\"" + std::string(100'000, 'k') + "\": 1, \"\xC3\xA9\\u0000\\n\": 2}");
  ASSERT_THAT(errors, SizeIs(2));
  EXPECT_LT(errors[0].detail.size(), 400U);
  EXPECT_THAT(errors[1].detail, HasSubstr("\"\xC3\xA9\\u0000\\n\""));
}

// Shares of a minute, since sanitizers slow everything: quadratic time would take many.
TEST(DecodeStudy, WideAndLongDocumentsTakeLinearTime) {
  const auto start = std::chrono::steady_clock::now();
  std::string wide = "{";
  for (int i = 0; i < 200'000; ++i) wide += "\"k" + std::to_string(i) + "\":1,";
  EXPECT_THAT(errors_of(wide + "\"name\":\"x\"}"), SizeIs(most_errors + 1));
  std::string sweep = R"({"plant": {"m1": {"sweep": [1)";
  for (int i = 2; i <= 100'000; ++i) (sweep += ',') += std::to_string(i);
  EXPECT_THAT(errors_of(sweep + "]}}}"), SizeIs(0));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(DecodeStudy, NestingIsLimitedAtThirtyTwoLevels) {
  const auto nested = [](int levels) {
    return "{\"name\": " + std::string(static_cast<std::size_t>(levels) - 1, '[') +
           std::string(static_cast<std::size_t>(levels) - 1, ']') + "}";
  };
  EXPECT_THAT(errors_of(nested(32)).front().detail, HasSubstr("an array is not a string"));
  EXPECT_THAT(errors_of(nested(33)).front().detail, HasSubstr("nested too deep (at most 32 levels)"));
  EXPECT_THAT(errors_of(std::string(1'000'000, '[')).front().detail, HasSubstr("nested too deep"));
}

TEST(DecodeStudy, SweepsMakeAHundredThousandCellsAndNotOneMore) {
  const auto sweeps = [](int m1, int m2) {
    std::string spec = R"({"plant": {"m1": {"sweep": [1)";
    for (int i = 2; i <= m1; ++i) (spec += ',') += std::to_string(i);
    spec += R"(]}, "m2": {"sweep": [1)";
    for (int i = 2; i <= m2; ++i) (spec += ',') += std::to_string(i);
    return spec + "]}}}";
  };
  EXPECT_THAT(errors_of(sweeps(1000, 100)), SizeIs(0));
  EXPECT_THAT(errors_of(sweeps(1001, 100)), SizeIs(1));
  EXPECT_THAT(errors_of(sweeps(100'000, 1)), SizeIs(0));
  EXPECT_THAT(errors_of(sweeps(100'001, 1)), SizeIs(1));
}

TEST(DecodeStudy, TrialsTimesCellsAreLimited) {
  const auto spec = [](const std::string& trials) {
    return R"({"plant": {"m1": {"sweep": [1, 2]}}, "sampling": {"trials": )" + trials + "}}";
  };
  EXPECT_THAT(errors_of(spec("500000000")), SizeIs(0));
  EXPECT_THAT(errors_of(spec("500000001")), SizeIs(1));
}

TEST(DecodeStudy, IntegersAreTakenExactlyOrNotAtAll) {
  const auto seed = [](const std::string& text) {
    return study_of(R"({"sampling": {"seed": )" + text + "}}").sampling.seed;
  };
  EXPECT_EQ(seed("18446744073709551615"), 18446744073709551615U);
  EXPECT_EQ(seed("9007199254740993"), 9007199254740993U);  // no double
  EXPECT_EQ(seed("9007199254740992.0"), 9007199254740992U);
  EXPECT_EQ(seed("-0"), 0U);
  EXPECT_EQ(seed("-0.0"), 0U);
  EXPECT_THAT(errors_of(R"({"sampling": {"seed": 9007199254740994.0}})"), SizeIs(1));
  EXPECT_THAT(errors_of(R"({"sampling": {"seed": 18446744073709551616}})"), SizeIs(1));
  EXPECT_THAT(errors_of(R"({"sampling": {"seed": -9223372036854775809}})"), SizeIs(1));
  EXPECT_THAT(errors_of(R"({"sampling": {"trials": 4294967297000}})"), SizeIs(1));
}

TEST(DecodeStudy, MinusZeroIsZero) {
  const Study study = study_of(R"({"initial_state": {"q1": -0.0}})");
  EXPECT_FALSE(std::signbit(std::get<double>(study.inputs[12].value)));
  EXPECT_EQ(study.inputs[12].name, "initial_state.q1");
}

TEST(DecodeStudy, ARuleOfTwoNumbersIsNotCheckedWhenOneIsMistaken) {
  const auto errors = errors_of(R"({"controller": {"alignment": {"tolerance": "0.5"}}})");
  EXPECT_THAT(errors, SizeIs(1));
}

TEST(DecodeStudy, EveryShippedSpecDecodes) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(STEERSTAT_SOURCE_DIR "/studies/specs")) {
    if (entry.path().extension() != ".json" || entry.path().stem().extension() == ".summary") continue;
    std::ifstream file(entry.path());
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_NO_THROW(decode_any_study(text.str(), entry.path().parent_path())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 7);
}

TEST(CanonicalSpec, SortsKeysAndFillsInEveryDefault) {
  EXPECT_EQ(canonical_spec(study_of("{}")), canonical_empty_spec);
}

TEST(CanonicalSpec, LeavesOutIntervalsThatAreTheDefault) {
  EXPECT_EQ(canonical_spec(study_of(R"({"intervals": {"method": "wilson", "level": 0.95}})")), canonical_empty_spec);
  EXPECT_THAT(canonical_spec(study_of(R"({"intervals": {"method": "clopper_pearson", "level": 0.95}})")),
              ::testing::HasSubstr(R"("intervals":{"method":"clopper_pearson"})"));
  EXPECT_THAT(canonical_spec(study_of(R"({"intervals": {"level": 0.9}})")),
              ::testing::HasSubstr(R"("intervals":{"level":0.9})"));
}

TEST(CanonicalSpec, LeavesOutImperfectionsThatAreOffAndFillsInAllOthersOnceOneIsOn) {
  EXPECT_EQ(canonical_spec(study_of(R"({"plant": {"coulomb1": 0, "coulomb_speed1": 0.001, "gravity_y": 0},
      "actuator": {"gain": 1}, "sensor": {"bias": {"q1": 0}, "noise": {}}})")),
            canonical_empty_spec);
  const std::string tilted = canonical_spec(study_of(R"({"plant": {"gravity_y": 0.5}})"));
  EXPECT_THAT(tilted, HasSubstr(R"({"actuator":{"gain":1},"audit")"));
  EXPECT_THAT(tilted, HasSubstr(R"("coulomb1":0,"coulomb2":0,"coulomb_speed1":0.001,"coulomb_speed2":0.001)"));
  EXPECT_THAT(tilted, HasSubstr(R"("gravity_x":0,"gravity_y":0.5)"));
  EXPECT_THAT(tilted, HasSubstr(R"("sensor":{"bias":{"q1":0,"q1_dot":0,"q2":0,"q2_dot":0},"noise":{"q1":0,)"));
  EXPECT_THAT(canonical_spec(study_of(R"({"actuator": {"max_force": 20}})")),
              HasSubstr(R"({"actuator":{"gain":1,"max_force":20},"audit")"));
}

TEST(CanonicalSpec, DoesNotDependOnHowTheSpecWasWritten) {
  EXPECT_EQ(canonical_spec(study_of(R"({"plant": {"m1": 1.50, "m2": 1e0}, "horizon": 3e2})")),
            canonical_spec(study_of(R"({ "horizon":300.0, "plant":{"m2":1,"m1":15e-1} })")));
}

TEST(CanonicalSpec, NumbersComeBackToTheSameBits) {
  for (const double x : {0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, 123456789012345680.0, -2.5e-7}) {
    Study study = study_of("{}");
    constexpr std::size_t q1 = 12;
    ASSERT_EQ(study.inputs[q1].name, "initial_state.q1");
    study.inputs[q1].value = x;
    EXPECT_EQ(std::get<double>(study_of(canonical_spec(study)).inputs[q1].value), x);
  }
}

TEST(SpecSha256, IsTheDigestOfTheCanonicalSpec) {
  // sha256sum of canonical_empty_spec
  EXPECT_EQ(spec_sha256(study_of("{}")), "dd59846f812b88ef8071d1a34292f87a2d158db6b2e8245574d440be1a8d0022");
}

TEST(SpecSha256, IsTheSameWhereMetricsAreMeasuredAsByDefault) {
  EXPECT_EQ(canonical_spec(study_of(R"({"metrics": true})")), canonical_empty_spec);
  const Study without = study_of(R"({"metrics": false})");
  EXPECT_FALSE(without.integrator.metrics);
  EXPECT_NE(spec_sha256(without), spec_sha256(study_of("{}")));
  EXPECT_EQ(study_of(canonical_spec(without)), without);
}

TEST(StudyId, IsSixteenHexadecimalDigitsThatTellStudiesApart) {
  const std::set<std::string> ids{study_id(study_of("{}")), study_id(study_of(R"({"sampling": {"seed": 2}})")),
                                  study_id(study_of(R"({"name": "other"})")),
                                  study_id(study_of(R"({"horizon": 301})"))};
  EXPECT_EQ(ids.size(), 4U);
  for (const std::string& id : ids) EXPECT_THAT(id, ::testing::MatchesRegex("[0-9a-f]{16}"));
  EXPECT_EQ(study_id(study_of("{}")), study_id(study_of(R"({"horizon": 300})")));
  EXPECT_NE(study_id(study_of("{}")), spec_sha256(study_of("{}")).substr(0, 16));  // the version is part of it
}

}  // namespace
}  // namespace steerstat
