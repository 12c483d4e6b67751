#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/robust_policy.hpp"
#include "study/inputs.hpp"
#include "view/columns_json.hpp"
#include "view/trial_view.hpp"

namespace steerstat {
namespace {

using view_json::Json;

constexpr int time_digits = 9;  // short phases late in a long trial

Json parameters_json(const TrialView& view) {
  TrialParameters parameters = view.parameters;  // its fields are reached through references
  Json json = Json::array();
  for (const InputDefinition& input : input_definitions()) {
    const double value = input.field(parameters);
    const bool varies = std::find(view.varying.begin(), view.varying.end(), input.name) != view.varying.end();
    json.push_back({{"input", input.name},
                    {"unit", input.unit},
                    {"value", std::isfinite(value) ? Json(value) : Json(nullptr)},
                    {"varies", varies}});
  }
  return json;
}

Json outcome_json(const TrialOutcome& outcome) {
  const auto finite = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  return {{"status", name_of(outcome.status)},
          {"end_time", outcome.end_time},
          {"cycles", outcome.cycles},
          {"swings", outcome.swings},
          {"alignments", outcome.alignments},
          {"passive_error", finite(outcome.passive_error)},
          {"active_error", finite(outcome.active_error)},
          {"effort", finite(outcome.effort)},
          {"peak_acceleration", finite(outcome.peak_acceleration)},
          {"peak_force", finite(outcome.peak_force)},
          {"peak_stroke", finite(outcome.peak_stroke)}};
}

Json references_json(const TrialView& view) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const Goal& goal = view.parameters.goal;
  const double turns = std::round((view.outcome.end_state.q2 - goal.q2) / turn);
  return {{"q1", goal.q1}, {"q2", goal.q2}, {"q2_nearest", goal.q2 + (std::isfinite(turns) ? turns * turn : 0.0)}};
}

template <class Value>
Json column(const std::vector<TrajectorySample>& samples, const Value& value, int digits = view_json::shown_digits) {
  Json json = Json::array();
  // What is not finite, of a trial that diverged, keeps its place as the point before it.
  Json last = 0;
  for (const TrajectorySample& sample : samples) {
    const Json number = view_json::number(value(sample), digits);
    if (!number.is_null()) last = number;
    json.push_back(last);
  }
  return json;
}

Json trajectory_json(const TrialView& view) {
  using Sample = TrajectorySample;
  const std::vector<Sample>& samples = view.samples;
  return {{"of", view.of},
          {"largest_deviation", view_json::number(std::min(view.largest_deviation, 1.0), 3)},
          {"t", column(
                    samples, [](const Sample& s) { return s.t; }, time_digits)},
          {"q1", column(samples, [](const Sample& s) { return s.state.q1; })},
          {"q2", column(samples, [](const Sample& s) { return s.state.q2; })},
          {"q1_dot", column(samples, [](const Sample& s) { return s.state.q1_dot; })},
          {"q2_dot", column(samples, [](const Sample& s) { return s.state.q2_dot; })},
          {"a", column(samples, [](const Sample& s) { return s.a; })},
          {"tau", column(samples, [](const Sample& s) { return s.tau; })}};
}

Json phases_json(const TrialView& view) {
  Json kind = Json::array(), start = Json::array(), end = Json::array(), first = Json::array(), last = Json::array();
  for (const PhaseSpan& phase : view.phases) {
    kind.push_back(name_of(phase.kind));
    start.push_back(view_json::number(view.samples[phase.first].t, time_digits));
    end.push_back(view_json::number(view.samples[phase.last].t, time_digits));
    first.push_back(phase.first);
    last.push_back(phase.last);
  }
  return {{"of", view.phases_of},  {"kind", std::move(kind)},   {"start", std::move(start)},
          {"end", std::move(end)}, {"first", std::move(first)}, {"last", std::move(last)}};
}

Json contraction_json(const TrialView& view) {
  const auto column = [&](double ContractionCycle::*member, int digits = view_json::shown_digits) {
    Json json = Json::array();
    for (const ContractionCycle& cycle : view.cycles) json.push_back(view_json::number(cycle.*member, digits));
    return json;
  };
  const Controller& controller = view.parameters.controller;
  const bool paper = controller.policy == Policy::paper;
  return {{"eta1", paper ? Json(controller.contraction.eta1) : Json(nullptr)},
          {"eta2", paper ? Json(controller.contraction.eta2) : Json(nullptr)},
          {"rate", paper ? Json(nullptr) : Json(controller.robust.rate)},
          {"start", column(&ContractionCycle::start, time_digits)},
          {"end", column(&ContractionCycle::end, time_digits)},
          {"distance_before", column(&ContractionCycle::distance_before)},
          {"distance_after", column(&ContractionCycle::distance_after)},
          {"distance_predicted", column(&ContractionCycle::distance_predicted)},
          {"speed_before", column(&ContractionCycle::speed_before)},
          {"speed_after", column(&ContractionCycle::speed_after)},
          {"speed_predicted", column(&ContractionCycle::speed_predicted)},
          {"passive_error_after", column(&ContractionCycle::passive_error_after)},
          {"tolerance", controller.convergence.tolerance}};
}

/// CONTROLLER.md section 5, rule 4, or rule 1 of the robust policy.
Json contraction_set_json(const TrialView& view) {
  const Goal& goal = view.parameters.goal;
  const Controller& controller = view.parameters.controller;
  const bool paper = controller.policy == Policy::paper;
  const double fraction = paper ? controller.entry_fraction : controller.robust.entry_fraction;
  const double rate = paper ? (1.0 - controller.contraction.eta1) / controller.contraction.max_period
                            : braking_share * controller.robust.rate;
  return {{"sigma", goal.sigma > 0.0 ? 1 : -1},
          {"q2_entry", goal.edge + goal.sigma * fraction * goal.width},
          {"q2_goal", goal.q2},
          {"least_rate", rate}};
}

}  // namespace

std::string trial_view_json(const TrialView& view) {
  Json json;
  json["view"] = "trial";
  json["version"] = view_version;
  json["study"] = view_json::identity(view.study);
  json["index"] = view.index;
  json["cell"] = view.cell;
  json["parameters"] = parameters_json(view);
  json["policy"] = policy_names[static_cast<std::size_t>(view.parameters.controller.policy)];
  json["realignment"] = realignment_names[static_cast<std::size_t>(view.parameters.controller.realignment)];
  json["horizon"] = view.parameters.controller.horizon;
  json["outcome"] = outcome_json(view.outcome);
  json["references"] = references_json(view);
  json["trajectory"] = trajectory_json(view);
  json["phases"] = phases_json(view);
  json["contraction"] = contraction_json(view);
  json["contraction_set"] = contraction_set_json(view);
  json["robot"] = {{"d2", view.parameters.plant.d2},
                   {"q1_low", view_json::number(view.q1_low)},
                   {"q1_high", view_json::number(view.q1_high)}};
  return view_json::text(json);
}

}  // namespace steerstat
