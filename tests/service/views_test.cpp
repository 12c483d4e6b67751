#include "core/errors.hpp"
#include "json_text.hpp"
#include "report/summary.hpp"
#include "service_fixture.hpp"
#include "view/study_view.hpp"
#include "view/success_map.hpp"

namespace steerstat::testing {
namespace {

using nlohmann::json;

class Views : public ServiceCase {};

TEST_F(Views, OfAStudySayWhatItsSummarySays) {
  const std::string id = service->submit(quick_spec(300)).state.id;
  const StudyState state = wait_for(id, StudyStatus::succeeded);
  const auto text = service->study_view(id);
  const json view = json_of(*text);
  json summary = json_of(service->summary(id).json);
  EXPECT_EQ(view["created"], state.created);
  EXPECT_EQ(view["summary"]["outcomes"], summary["outcomes"]);
  EXPECT_EQ(view["sample"]["index"].size(), 300U);
  EXPECT_EQ(service->study_view(id), text) << "it is kept, not made again";
  restart();
  EXPECT_EQ(*service->study_view(id), *text);
}

TEST_F(Views, OfAStudyReadBackAreThoseOfItsSummaryMadeAndItsParametersDrawnAnew) {
  for (const char* more : {"", R"(, "controller": {"contraction": {"eta2": {"sweep": [0.5, 0.6]}}})"}) {
    const std::string spec = quick_spec(200, 3, more);
    const std::string id = service->submit(spec).state.id;
    const StudyState state = wait_for(id, StudyStatus::succeeded);
    restart();
    const StoredStudy stored = read_result(data / "studies" / id / "results.h5");
    const auto parameters = drawn_parameters(Plan(stored.study), stored.result.trials);
    const Summary summary = summarise(stored.study, stored.result);
    const StudyView view = study_view({stored.study, stored.result, parameters}, {state.created});
    EXPECT_EQ(*service->study_view(id), study_view_json(view, summary)) << more;
    restart();
    EXPECT_EQ(service->success_map(id, "plant.m1", "plant.f2"),
              success_map_json(success_map({stored.study, stored.result, parameters}, "plant.m1", "plant.f2")));
  }
}

TEST_F(Views, OfARunningStudyAreOfItsFinishedTrials) {
  const std::string id = service->submit(long_spec()).state.id;
  wait_for_kept_trials(id);
  const json view = json_of(*service->study_view(id));
  EXPECT_FALSE(view["summary"]["complete"].get<bool>());
  EXPECT_GT(view["trials"]["finished"].get<std::uint64_t>(), 0U);
  EXPECT_EQ(view["narrowing"]["of"], view["trials"]["finished"]);
  const json map = json_of(service->success_map(id, "plant.m1", "plant.f2"));
  EXPECT_GT(map["of"].get<std::uint64_t>(), 0U);
  EXPECT_THROW(static_cast<void>(service->success_map(id, "plant.m1", "plant.m2")), NoSuchAxis);
  service->cancel_or_remove(id);
  wait_for_end(id);
}

TEST_F(Views, OfAStudyThatSeeksFailuresHaveItsWeightedSummaryAndNoMaps) {
  const std::string spec = R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}}, "horizon": 60,
      "audit": {"trials": 0}, "sampling": {"method": "importance", "trials": 2000, "seed": 5}})";
  const std::string id = service->submit(spec).state.id;
  wait_for(id, StudyStatus::succeeded);
  const Study study = decode_study(spec, {});
  json expected = json_of(summary_json(summarise(study, run_study(study, {}))));
  json summary = json_of(service->summary(id).json);
  EXPECT_FALSE(summary["rare_failures"].is_null());
  EXPECT_EQ(summary["rare_failures"], expected["rare_failures"]);
  EXPECT_EQ(summary["success_rate"], expected["success_rate"]);
  const json view = json_of(*service->study_view(id));
  EXPECT_EQ(view["rows"], "sought");
  EXPECT_EQ(view["summary"]["success_rate"], summary["success_rate"]);
  EXPECT_EQ(view["marginals"], json::array());
  EXPECT_THROW(static_cast<void>(service->success_map(id, "plant.m1", "plant.f2")), BadUsage);
  EXPECT_THROW(static_cast<void>(service->compare(id, id)), StudiesDoNotPair);
  EXPECT_EQ(json_of(service->trial_view(id, 3))["index"], 3);
}

TEST_F(Views, OfARunningStudyThatSeeksFailuresHaveItsWeightedSummary) {
  const std::string id = service
                             ->submit(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
      "audit": {"trials": 0}, "sampling": {"method": "importance", "trials": 1000000}})")
                             .state.id;
  wait_for_kept_trials(id);
  const json summary = json_of(service->summary(id).json);
  EXPECT_FALSE(summary["complete"].get<bool>());
  EXPECT_EQ(summary["rare_failures"]["method"], "importance");
  EXPECT_TRUE(summary["settling_time"]["p50"].is_null());
  EXPECT_EQ(json_of(*service->study_view(id))["rows"], "sought");
  service->cancel_or_remove(id);
  wait_for_end(id);
}

TEST_F(Views, OfATrialEndAsTheTrialDid) {
  const std::string id = service->submit(quick_spec(20)).state.id;
  wait_for(id, StudyStatus::succeeded);
  const TrialOutcome outcome = service->trial(id, 7).rows.front().outcome;
  const json view = json_of(service->trial_view(id, 7));
  EXPECT_EQ(view["index"], 7);
  EXPECT_EQ(view["outcome"]["end_time"].get<double>(), outcome.end_time);
  EXPECT_THROW(static_cast<void>(service->trial_view(id, 20)), NoSuchTrial);
}

TEST_F(Views, OfTwoStudiesHoldTheirComparison) {
  const std::string a = service->submit(quick_spec(100)).state.id;
  const std::string b = service->submit(quick_spec(100, 1, R"(, "controller": {"rest_speed": 0.002})")).state.id;
  wait_for(a, StudyStatus::succeeded);
  wait_for(b, StudyStatus::succeeded);
  const json view = json_of(service->comparison_view(a, b));
  EXPECT_EQ(view["comparison"]["pairs"]["total"], 100);
  EXPECT_EQ(view["settling_time"]["a"]["trials"].get<std::uint64_t>(),
            view["comparison"]["pairs"]["both"].get<std::uint64_t>() +
                view["comparison"]["pairs"]["a_only"].get<std::uint64_t>());
}

}  // namespace
}  // namespace steerstat::testing
