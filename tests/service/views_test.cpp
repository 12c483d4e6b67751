#include "core/errors.hpp"
#include "json_text.hpp"
#include "report/summary.hpp"
#include "service_fixture.hpp"
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
