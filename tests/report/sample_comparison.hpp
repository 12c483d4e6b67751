#pragma once

#include <string>
#include <utility>
#include <vector>

#include "../store/sample_result.hpp"
#include "report/comparison.hpp"

/// Studies with made-up outcomes to compare: no simulation.
namespace steerstat::testing_report {

/// A study and what a result file of it would hold.
struct Finished {
  Study study;
  StudyResult result;
  std::vector<std::vector<double>> parameters;

  [[nodiscard]] ComparedStudy compared(std::string engine_version = "0.1.0") const {
    return {study, result, parameters, std::move(engine_version)};
  }
};

/// Fills in the stored parameters of the finished trials.
inline void store_parameters(Finished& finished) {
  const Plan plan(finished.study);
  finished.parameters.assign(plan.varying().size(), {});
  std::vector<double> values(plan.varying().size());
  for (const std::uint64_t index : finished.result.trials.index) {
    plan.draw(index, values);
    for (std::size_t i = 0; i < values.size(); ++i) finished.parameters[i].push_back(values[i]);
  }
}

/// A study of `spec`, every trial finished with made-up outcomes that `seed` decides.
inline Finished finished(const std::string& spec, unsigned seed = 1) {
  Finished made{decode_study(spec, {}), {}, {}};
  made.result = testing_store::made_up_result(made.study, seed);
  store_parameters(made);
  return made;
}

/// Keeps the trials whose index `keep` says true to, as an interrupted run would.
template <class Keep>
void keep_trials(Finished& finished, const Keep& keep) {
  TrialTable kept;
  for (std::size_t row = 0; row < finished.result.trials.index.size(); ++row) {
    if (!keep(finished.result.trials.index[row])) continue;
    kept.index.push_back(finished.result.trials.index[row]);
    kept.outcomes.push_back(finished.result.trials.outcomes[row]);
  }
  finished.result.trials = std::move(kept);
  finished.result.complete = false;
  store_parameters(finished);
}

/// A spec with drawn inputs; `more` is further members, each with a leading comma.
inline std::string drawn_spec(int trials, const std::string& more = "") {
  return R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}}, "sampling": {"trials": )" +
         std::to_string(trials) + "}" + more + "}";
}

}  // namespace steerstat::testing_report
