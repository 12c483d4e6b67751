#include "report/trajectory_json.hpp"

#include "study/spec_json.hpp"
#include "trial/metric.hpp"

namespace steerstat {

using Json = nlohmann::ordered_json;

Json outcome_json(const TrialOutcome& outcome) {
  Json json{{"status", name_of(outcome.status)},
            {"settling_time", outcome.settling_time()},
            {"end_time", outcome.end_time},
            {"cycles", outcome.cycles},
            {"swings", outcome.swings},
            {"alignments", outcome.alignments},
            {"passive_error", outcome.passive_error},
            {"active_error", outcome.active_error},
            {"q1", outcome.end_state.q1},
            {"q2", outcome.end_state.q2},
            {"q1_dot", outcome.end_state.q1_dot},
            {"q2_dot", outcome.end_state.q2_dot}};
  for (const Metric& metric : metrics()) {
    if (!json.contains(metric.name)) json[std::string(metric.name)] = metric.value(outcome);
  }
  return json;
}

namespace {

Json samples_json(const std::vector<TrajectorySample>& samples) {
  Json t = Json::array(), q1 = Json::array(), q2 = Json::array(), q1_dot = Json::array(), q2_dot = Json::array(),
       a = Json::array(), tau = Json::array(), phase = Json::array();
  for (const TrajectorySample& sample : samples) {
    t.push_back(sample.t);
    q1.push_back(sample.state.q1);
    q2.push_back(sample.state.q2);
    q1_dot.push_back(sample.state.q1_dot);
    q2_dot.push_back(sample.state.q2_dot);
    a.push_back(sample.a);
    tau.push_back(sample.tau);
    phase.push_back(name_of(sample.phase));
  }
  return {{"t", std::move(t)},           {"q1", std::move(q1)}, {"q2", std::move(q2)},   {"q1_dot", std::move(q1_dot)},
          {"q2_dot", std::move(q2_dot)}, {"a", std::move(a)},   {"tau", std::move(tau)}, {"phase", std::move(phase)}};
}

}  // namespace

std::string trajectory_json(const Study& study, std::uint64_t index, const std::vector<std::string>& names,
                            const std::vector<double>& values, const Trajectory& trajectory) {
  Json parameters = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) parameters[names[i]] = values[i];
  const Json document{{"study", {{"id", study_id(study)}, {"name", study.name}}},
                      {"index", index},
                      {"parameters", std::move(parameters)},
                      {"outcome", outcome_json(trajectory.outcome)},
                      {"trajectory", samples_json(trajectory.samples)}};
  return document.dump() + "\n";
}

}  // namespace steerstat
