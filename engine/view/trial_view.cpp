#include "view/trial_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "control/goal.hpp"
#include "control/robust_policy.hpp"
#include "view/thinning.hpp"

namespace steerstat {
namespace {

constexpr int samples_per_cycle = 32;

std::vector<ContractionCycle> cycles_of(const Trajectory& trajectory, std::size_t phases,
                                        const TrialParameters& parameters) {
  const Goal& goal = parameters.goal;
  const Controller& controller = parameters.controller;
  const bool is_robust = controller.policy == Policy::robust;
  std::vector<ContractionCycle> cycles;
  for (std::size_t i = 0; i < phases; ++i) {
    const PhaseSpan& phase = trajectory.phases[i];
    if (phase.kind != PhaseKind::contraction || !phase.whole) continue;
    const TrajectorySample& start = trajectory.samples[phase.first];
    const bool aligns = is_robust && i + 1 < phases && trajectory.phases[i + 1].kind == PhaseKind::align;
    const TrajectorySample& end = trajectory.samples[trajectory.phases[aligns ? i + 1 : i].last];
    // Followed through the cycle, as ContractionRecord does: u jumps by a turn where the link passes the edge.
    const double before = goal.width - modulo_turn(goal.sigma * (start.state.q2 - goal.edge));
    const double after = before - goal.sigma * (end.state.q2 - start.state.q2);
    const double omega = goal.sigma * start.state.q2_dot;
    const auto& [eta1, eta2, max_period] = controller.contraction;
    ContractionCycle cycle{start.t,
                           end.t,
                           before,
                           after,
                           eta1 * before,
                           omega,
                           goal.sigma * end.state.q2_dot,
                           eta2 * omega,
                           passive_error(end.state, goal)};
    if (is_robust) {
      const BrakingAim aim = braking_aim(start.state, controller, goal);
      cycle.distance_predicted = aligns ? aim.distance_after_align : aim.distance_after_cycle;
      cycle.speed_predicted = aim.speed;
    }
    cycles.push_back(cycle);
  }
  return cycles;
}

/// The samples that must stay: where the first `phases` phases begin and end, and the last of all.
std::vector<std::size_t> fixed_samples(const Trajectory& trajectory, std::size_t phases) {
  std::vector<std::size_t> fixed;
  for (std::size_t i = 0; i < phases; ++i) {
    fixed.push_back(trajectory.phases[i].first);
    fixed.push_back(trajectory.phases[i].last);
  }
  if (!trajectory.samples.empty()) fixed.push_back(trajectory.samples.size() - 1);
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  return fixed;
}

std::array<std::vector<double>, 6> curves_of(const std::vector<TrajectorySample>& samples) {
  std::array<std::vector<double>, 6> curves;
  for (const TrajectorySample& sample : samples) {
    const State<double>& x = sample.state;
    const std::array<double, 6> values{x.q1, x.q2, x.q1_dot, x.q2_dot, sample.a, sample.tau};
    for (std::size_t c = 0; c < curves.size(); ++c) curves[c].push_back(values[c]);
  }
  return curves;
}

}  // namespace

Trajectory replay_for_view(const TrialParameters& parameters, const IntegratorChoice& integrator,
                           const std::function<void()>& check_in) {
  return replay(parameters, integrator, 0.05, samples_per_cycle, check_in);
}

TrialView trial_view(const Study& study, std::uint64_t index, const TrialParameters& parameters,
                     const Trajectory& trajectory, std::size_t points) {
  const Plan plan(study);
  const std::vector<TrajectorySample>& samples = trajectory.samples;
  TrialView view;
  view.study = identity_of(study);
  view.index = index;
  view.cell = plan.cell_of(index);
  view.parameters = parameters;
  view.varying = plan.varying();
  view.outcome = trajectory.outcome;
  view.of = samples.size();
  view.phases_of = trajectory.phases.size();
  // A trial may have thousands of phases; half of the points at most go to their ends.
  const std::size_t phases = std::min({view.phases_of, most_listed_phases, points / 4});
  view.cycles = cycles_of(trajectory, phases, parameters);
  view.q1_low = view.q1_high = parameters.start.q1;
  if (samples.empty()) return view;  // it ended where it started

  std::vector<double> t;
  t.reserve(samples.size());
  for (const TrajectorySample& sample : samples) {
    t.push_back(sample.t);
    view.q1_low = std::min(view.q1_low, sample.state.q1);
    view.q1_high = std::max(view.q1_high, sample.state.q1);
  }
  const Thinned thinned = thin(t, curves_of(samples), fixed_samples(trajectory, phases), points);
  view.largest_deviation = thinned.largest_deviation;
  for (const std::size_t kept : thinned.kept) view.samples.push_back(samples[kept]);
  const auto place_of = [&](std::size_t sample) {
    return static_cast<std::size_t>(
        std::distance(thinned.kept.begin(), std::lower_bound(thinned.kept.begin(), thinned.kept.end(), sample)));
  };
  for (std::size_t i = 0; i < phases; ++i) {
    const PhaseSpan& phase = trajectory.phases[i];
    view.phases.push_back({phase.kind, place_of(phase.first), place_of(phase.last), phase.whole});
  }
  return view;
}

}  // namespace steerstat
