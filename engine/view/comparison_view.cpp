#include "view/comparison_view.hpp"

#include <algorithm>

#include "study/inputs.hpp"
#include "study/plan.hpp"

namespace steerstat {
namespace {

struct Pairs {
  const ComparedStudy& a;
  const ComparedStudy& b;
  const Pairing& pairing;
  const std::string obstacle;  // to a band about a distribution

  [[nodiscard]] const TrialOutcome& in_a(std::size_t pair) const {
    return a.result.trials.outcomes[pairing.rows[pair].first];
  }
  [[nodiscard]] const TrialOutcome& in_b(std::size_t pair) const {
    return b.result.trials.outcomes[pairing.rows[pair].second];
  }

  /// Of the pairs for which `time` has a value, not NaN.
  template <class Time>
  [[nodiscard]] EmpiricalDistribution distribution(const Time& time) const {
    std::vector<double> values;
    for (std::size_t pair = 0; pair < pairing.rows.size(); ++pair) {
      if (const double value = time(pair); value == value) values.push_back(value);
    }
    return empirical_distribution("settling_time", "s", std::move(values), obstacle, comparison_level);
  }
};

ComparisonView::Discordant discordant_of(const Pairs& pairs, const std::vector<std::size_t>& columns) {
  ComparisonView::Discordant discordant;
  discordant.inputs.resize(columns.size());
  std::size_t a_only = 0;
  std::size_t b_only = 0;
  for (std::size_t pair = 0; pair < pairs.pairing.rows.size(); ++pair) {
    const TrialOutcome& a = pairs.in_a(pair);
    const TrialOutcome& b = pairs.in_b(pair);
    const bool converged = a.status == Status::converged;
    if (converged == (b.status == Status::converged)) continue;
    if ((converged ? a_only : b_only)++ >= most_shown_discordant) continue;
    const std::size_t row = pairs.pairing.rows[pair].first;
    discordant.index.push_back(pairs.a.result.trials.index[row]);
    discordant.status_a.push_back(a.status);
    discordant.status_b.push_back(b.status);
    discordant.settling_time.push_back((converged ? a : b).settling_time());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      discordant.inputs[i].push_back(pairs.a.parameters[columns[i]][row]);
    }
  }
  return discordant;
}

void shorten(DiscordantTrials& trials) {
  trials.indices.resize(std::min(trials.indices.size(), most_shown_discordant));
}

}  // namespace

ComparisonView comparison_view(const ComparedStudy& a, const ComparedStudy& b) {
  ComparisonView view;
  view.comparison = compare(a, b);
  shorten(view.comparison.a_only);
  shorten(view.comparison.b_only);
  const Pairing pairing = pair_trials(a, b, view.comparison.differences);
  const Plan plan(a.study);
  const Pairs pairs{a, b, pairing, obstacle_to_band(a.study, plan.cells())};
  view.a = pairs.distribution([&](std::size_t pair) { return pairs.in_a(pair).settling_time(); });
  view.b = pairs.distribution([&](std::size_t pair) { return pairs.in_b(pair).settling_time(); });
  view.difference = pairs.distribution(
      [&](std::size_t pair) { return pairs.in_b(pair).settling_time() - pairs.in_a(pair).settling_time(); });
  std::vector<std::size_t> columns;
  for (const std::string& name : pairing.drawn) {
    const auto found = std::find(plan.varying().begin(), plan.varying().end(), name);
    if (found == plan.varying().end()) continue;
    columns.push_back(static_cast<std::size_t>(found - plan.varying().begin()));
    view.inputs.push_back({name, std::string(find_input(name)->unit)});
  }
  view.discordant = discordant_of(pairs, columns);
  return view;
}

}  // namespace steerstat
