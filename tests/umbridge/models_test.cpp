#include "umbridge/models.hpp"

#include <string>

#include "../service/service_fixture.hpp"
#include "json_text.hpp"
#include "study/plan.hpp"
#include "trial/runner.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;

class UmBridge : public ServiceCase {
 protected:
  [[nodiscard]] Json answer(const std::string& action, const std::string& body, int status = 200) const {
    const ModelReply reply = models.answer(action, body);
    EXPECT_EQ(reply.status, status) << reply.json;
    return ordered_json_of(reply.json);
  }
  [[nodiscard]] std::vector<double> output(const std::string& body) const {
    const Json answered = answer("Evaluate", body);
    EXPECT_EQ(answered.size(), 1U) << "clients choke on other keys";
    return answered["output"][0].get<std::vector<double>>();
  }
  void expect_refusal(const std::string& action, const std::string& body, const std::string& type,
                      const std::string& words) const {
    const Json error = answer(action, body, 400)["error"];
    EXPECT_EQ(error["type"], type) << body;
    EXPECT_THAT(error["message"].get<std::string>(), HasSubstr(words)) << body;
  }

  Models models{*service};
};

TEST_F(UmBridge, ListsItsModelsAndWhatTheySupport) {
  EXPECT_EQ(ordered_json_of(Models::info()),
            ordered_json_of(R"({"protocolVersion": 1.0, "models": ["trial", "study"]})"));
  EXPECT_EQ(
      answer("ModelInfo", R"({"name": "trial"})"),
      ordered_json_of(
          R"({"support": {"Evaluate": true, "Gradient": false, "ApplyJacobian": false, "ApplyHessian": false}})"));
  EXPECT_EQ(answer("InputSizes", R"({"name": "trial"})"), ordered_json_of(R"({"inputSizes": [4]})"));
  EXPECT_EQ(answer("InputSizes", R"({"name": "trial", "config": {"inputs": ["plant.f2"]}})"),
            ordered_json_of(R"({"inputSizes": [1]})"));
  EXPECT_EQ(answer("OutputSizes", R"({"name": "study", "config": null})"), ordered_json_of(R"({"outputSizes": [3]})"));
}

TEST_F(UmBridge, AllZerosAreTheNominalRobot) {
  const TrialOutcome nominal = make_runner({})->run(TrialParameters{});
  const std::vector<double> zeros = output(R"({"name": "trial", "input": [[0, 0, 0, 0]]})");
  EXPECT_EQ(zeros, (std::vector<double>{1.0, nominal.settling_time(), static_cast<double>(nominal.cycles)}));
}

TEST_F(UmBridge, MassesDeviateByAShareAndFrictionThatIsNoneByItsUnit) {
  const Plan plan(decode_study(R"({"plant": {"m2": 1.1, "f2": 0.02}})", {}));
  const TrialOutcome expected = make_runner({})->run(plan.parameters(0));
  const std::vector<double> got = output(R"({"name": "trial", "input": [[0, 0.1, 0, 0.02]], "config": {}})");
  EXPECT_EQ(got[1], expected.settling_time());
  EXPECT_EQ(got[2], static_cast<double>(expected.cycles));
}

TEST_F(UmBridge, ATrialThatDoesNotConvergeSettlesAtTheHorizon) {
  const std::vector<double> got = output(R"({"name": "trial", "input": [[0, 0, 0, 0]],
                                             "config": {"spec": {"horizon": 12.5}}})");
  EXPECT_EQ(got[0], 0.0);
  EXPECT_EQ(got[1], 12.5);
}

TEST_F(UmBridge, ATrialThatTakesTooLongIsNotWaitedFor) {
  const TrialModel impatient(300.0, std::chrono::milliseconds(0));
  const Json config = ordered_json_of(R"({"inputs": ["initial_state.q2_dot"]})");
  try {
    static_cast<void>(impatient.evaluate(std::vector{1e8}, config));
    FAIL() << "it has ended";
  } catch (const ModelRefusal& refusal) {
    EXPECT_EQ(refusal.type(), ModelRefusal::invalid_output);
    EXPECT_THAT(refusal.what(), HasSubstr("takes longer"));
  }
}

TEST_F(UmBridge, TheModelIsLookedAtBeforeItsInput) {
  expect_refusal("Evaluate", R"({"name": "poisson", "input": 3})", "ModelNotFound", "\"poisson\"");
  expect_refusal("Evaluate", R"({"input": [[0]]})", "ModelNotFound", "null");
  expect_refusal("Gradient", R"({"name": "trial", "input": 3})", "UnsupportedFeature", "derivatives");
  expect_refusal("ApplyHessian", R"({"name": "study"})", "UnsupportedFeature", "derivatives");
}

TEST_F(UmBridge, SaysWhatIsWrongWithAnInput) {
  expect_refusal("Evaluate", "nonsense", "InvalidInput", "line 1");
  expect_refusal("Evaluate", "[1]", "InvalidInput", "object");
  expect_refusal("Evaluate", R"({"name": "trial"})", "InvalidInput", "one vector");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[0], [0]]})", "InvalidInput", "one vector");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[0, 0, 0]]})", "InvalidInput", "takes 4");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[0, 0, 0, "1"]]})", "InvalidInput", "\"1\"");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[-1, 0, 0, 0]]})", "InvalidInput", "/plant/m1");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[0]], "config": {"inputs": ["plant.m3"]}})", "InvalidInput",
                 "did you mean");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[0, 0]], "config": {"inputs": ["plant.m1", "plant.m1"]}})",
                 "InvalidInput", "twice");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[0, 0, 0, 0]], "config": {"sepc": {}}})", "InvalidInput",
                 "sepc");
  expect_refusal(
      "Evaluate",
      R"({"name": "trial", "input": [[0, 0, 0, 0]], "config": {"spec": {"plant": {"I2": {"uniform": [1, 2]}}}}})",
      "InvalidInput", "plant.I2 varies");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[0, 0, 0, 0]], "config": 7})", "InvalidInput", "config");
  expect_refusal("Evaluate", R"({"name": "trial", "input": [[0, 0, 0, 0]], "config": {"spec": {"horizon": 20001}}})",
                 "InvalidInput", "at most 20000 here");
}

TEST_F(UmBridge, AStudysRateIsThatOfTheServicesStudy) {
  const std::string spec = quick_spec(300);
  const std::string body = R"({"name": "study", "input": [[0.4, 0.7]], "config": {"study": )" + spec + "}}";
  const std::vector<double> got = output(body);
  const StudyPage page = service->list(10);
  ASSERT_EQ(page.studies.size(), 1U);
  const Json rate = ordered_json_of(service->summary(page.studies[0].id).json)["success_rate"];
  EXPECT_EQ(got, (std::vector<double>{rate["estimate"], rate["ci_low"], rate["ci_high"]}));
  const std::string by_id =
      R"({"name": "study", "input": [[0.4, 0.7]], "config": {"study": ")" + page.studies[0].id + "\"}}";
  EXPECT_EQ(output(by_id), got);
  EXPECT_EQ(service->list(10).studies.size(), 1U) << "the same input is the same study";
}

TEST_F(UmBridge, SaysWhatIsWrongWithAStudy) {
  const auto body = [](const std::string& study, const std::string& more = "") {
    return R"({"name": "study", "input": [[0.4, 0.7]], "config": {"study": )" + study + more + "}}";
  };
  expect_refusal("Evaluate", R"({"name": "study", "input": [[0.4, 0.7]]})", "InvalidInput", "config.study");
  expect_refusal("Evaluate", body("\"0123\""), "InvalidInput", "0123");
  expect_refusal("Evaluate", body("{\"controller\": 3}"), "InvalidInput", "/controller");
  expect_refusal("Evaluate", body("{}", R"(, "inputs": ["plant.m1", "plant.m2"])"), "InvalidInput", "no parameter");
  expect_refusal("Evaluate", body(R"({"plant": {"m1": {"sweep": [1, 2]}}})"), "InvalidInput", "sweeps");
  expect_refusal("Evaluate", R"({"name": "study", "input": [[4, 0.7]], "config": {"study": {}}})", "InvalidInput",
                 "/controller/contraction/eta1");
}

TEST_F(UmBridge, AStudyThatTakesTooLongGoesOn) {
  const StudyModel impatient(*service, std::chrono::seconds(0));
  Json config;
  config["study"] = ordered_json_of(long_spec());
  EXPECT_THROW(static_cast<void>(impatient.evaluate(std::vector{0.4, 0.7}, config)), ModelRefusal);
  EXPECT_EQ(service->list(10).studies.size(), 1U);
}

}  // namespace
}  // namespace steerstat::testing
