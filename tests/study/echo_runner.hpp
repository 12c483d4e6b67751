#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "study/plan.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {

inline Study spec_study(const std::string& spec) {
  return decode_study(spec, {});
}

/// Cheap stand-in for an engine: the outcome tells its trial's parameters, every fifth draw fails. Takes trials in
/// groups that straddle blocks and finishes each group backwards, as lanes may.
class EchoRunner final : public TrialRunner {
 public:
  using OnTrial = std::function<void(std::uint64_t index)>;

  explicit EchoRunner(OnTrial on_trial = {}) : on_trial_(std::move(on_trial)) {}

  static TrialOutcome outcome_of(const TrialParameters& parameters) {
    TrialOutcome outcome;
    const double digits = parameters.start.q1 * 1e6;
    const bool fails = digits - 5.0 * std::floor(digits / 5.0) < 1.0;
    outcome.status = fails ? Status::timeout : Status::converged;
    outcome.end_time = parameters.plant.m1;
    outcome.end_state = parameters.start;
    return outcome;
  }

  using TrialRunner::run;
  void run(TrialStream& stream) override {
    struct Trial {
      std::uint64_t index{};
      TrialParameters parameters{};
    };
    bool more = true;
    while (more) {
      std::vector<Trial> group;
      Trial trial;
      while (group.size() < 7 && (more = stream.next(trial.index, trial.parameters))) group.push_back(trial);
      for (auto it = group.rbegin(); it != group.rend(); ++it) {
        if (on_trial_) on_trial_(it->index);
        stream.finished(it->index, outcome_of(it->parameters));
      }
    }
    std::uint64_t index = 0;
    TrialParameters parameters;
    EXPECT_FALSE(stream.next(index, parameters)) << "a dry stream stays dry";
  }

 private:
  OnTrial on_trial_;
};

/// @param on_trial  called by workers as each trial ends
inline RunOptions echo_options(unsigned threads, EchoRunner::OnTrial on_trial = {}) {
  RunOptions options;
  options.threads = threads;
  options.make_runner = [on_trial](const IntegratorChoice&) { return std::make_unique<EchoRunner>(on_trial); };
  return options;
}

/// A study for an echo; blocks are of 16 trials.
inline Study drawn_study(std::uint64_t trials, const std::string& more = "") {
  return spec_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "initial_state": {"q1": {"uniform": [-1, 1]}},
                      "integrator": {"method": "cvode"}, "audit": {"trials": 0}, "sampling": {"trials": )" +
                    std::to_string(trials) + "}" + more + "}");
}

/// Expects the trials of an echo to be the first of the study.
inline void expect_kept_prefix(const Study& study, const TrialTable& trials) {
  const Plan plan(study);
  ASSERT_EQ(trials.index.size(), trials.outcomes.size());
  for (std::uint64_t row = 0; row < trials.index.size(); ++row) {
    EXPECT_EQ(trials.index[row], row);
    EXPECT_TRUE(same_bits(trials.outcomes[row], EchoRunner::outcome_of(plan.parameters(row)))) << "trial " << row;
  }
}

}  // namespace steerstat
