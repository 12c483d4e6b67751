#include "study/subset_simulation.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sampling/metropolis_candidates.hpp"
#include "sampling/monte_carlo.hpp"

namespace steerstat {
namespace {

SubsetLevels levels_of(const Sampling& sampling) {
  return {sampling.trials, sampling.levels};
}

/// The run under way.
class Simulation {
 public:
  Simulation(const Study& study, const RunOptions& options)
      : study_(study),
        options_(options),
        plan_(study),
        width_(plan_.varying().size()),
        draws_(study.sampling.seed, plan_.varying()),
        candidates_(study.sampling.seed, plan_.varying()),
        levels_(levels_of(study.sampling)) {
    run_.study = study;
    run_.study.sampling.explicit_names = plan_.varying();
    run_.result.simd = study.integrator.method == IntegratorChoice::Method::lockstep
                           ? std::optional<InstructionSet>(options.simd)
                           : std::nullopt;
    run_.result.threads = 1;
  }

  SubsetRun run() {
    while (!levels_.ended()) {
      place_due();
      if (!evaluate()) return interrupted();
    }
    return audited();
  }

 private:
  void place_due() {
    const std::uint64_t first = levels_.evaluated();
    const auto due = levels_.due();
    points_.resize((first + due.size()) * width_);
    for (std::uint64_t i = 0; i < due.size(); ++i) {
      const std::span<double> point(points_.data() + (first + i) * width_, width_);
      if (due[i]) {
        candidates_.place(first + i, {points_.data() + *due[i] * width_, width_}, point);
      } else {
        draws_.place(first + i, point);
      }
    }
  }

  /// Runs the trials due. @return whether all of them have finished
  bool evaluate() {
    const std::uint64_t first = levels_.evaluated();
    const std::uint64_t count = levels_.due().size();
    Study batch = run_.study;
    batch.sampling.explicit_values.resize(count * width_);
    batch.retention = {};
    batch.audited_trials = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      plan_.place({points_.data() + (first + i) * width_, width_},
                  {batch.sampling.explicit_values.data() + i * width_, width_});
    }
    StudyResult result = run_study(batch, options_of(first, count));
    run_.result.wall_s += result.wall_s;
    run_.result.threads = std::max(run_.result.threads, result.threads);
    if (!result.complete) return false;
    std::vector<double> performances;
    for (const TrialOutcome& outcome : result.trials.outcomes) performances.push_back(performance(outcome));
    auto& values = run_.study.sampling.explicit_values;
    values.insert(values.end(), batch.sampling.explicit_values.begin(), batch.sampling.explicit_values.end());
    auto& [index, outcomes] = run_.result.trials;
    for (std::uint64_t i = 0; i < count; ++i) index.push_back(first + i);
    outcomes.insert(outcomes.end(), result.trials.outcomes.begin(), result.trials.outcomes.end());
    levels_.take(performances);
    return true;
  }

  /// How far the run is: of the trials that it would have if no level beyond the one under way were needed.
  [[nodiscard]] RunOptions options_of(std::uint64_t first, std::uint64_t count) const {
    RunOptions options = options_;
    options.on_progress = nullptr;
    if (!options_.on_progress) return options;
    const std::uint64_t states = study_.sampling.trials;
    const std::uint64_t a_level = states - states / SubsetLevels::chain_length;
    const std::uint64_t requested = states + (first + count - states + a_level - 1) / a_level * a_level;
    options.on_progress = [this, first, requested](const Progress& progress) {
      options_.on_progress({first + progress.completed, requested, run_.result.wall_s + progress.elapsed, 0});
    };
    return options;
  }

  SubsetRun interrupted() {
    run_.study = study_;
    run_.result.trials = {};
    return std::move(run_);
  }

  /// The run's trials, of which some are retained and audited like any other study's.
  SubsetRun audited() {
    RunOptions options = options_;
    options.on_progress = nullptr;
    StudyResult result =
        run_study(run_.study, options, FinishedTrials{std::move(run_.result.trials), run_.result.wall_s});
    result.wall_s = run_.result.wall_s;
    result.threads = run_.result.threads;
    run_.result = std::move(result);
    return std::move(run_);
  }

  const Study& study_;
  const RunOptions& options_;
  const Plan plan_;
  const std::size_t width_;
  const MonteCarlo draws_;
  const MetropolisCandidates candidates_;
  SubsetLevels levels_;
  std::vector<double> points_;  // (evaluated x varying), in the unit cube
  SubsetRun run_;
};

}  // namespace

double performance(const TrialOutcome& outcome) {
  return outcome.status == Status::converged ? outcome.end_time : std::numeric_limits<double>::infinity();
}

SubsetRun run_subset_simulation(const Study& study, const RunOptions& options) {
  if (study.sampling.method != SamplingMethod::subset_simulation || !study.sampling.explicit_names.empty()) {
    throw std::invalid_argument("run_subset_simulation: the study is not one by subset simulation, or has run");
  }
  return Simulation(study, options).run();
}

SubsetLevels subset_levels(const Study& study, const TrialTable& trials) {
  SubsetLevels levels = levels_of(study.sampling);
  std::size_t row = 0;
  std::vector<double> performances;
  while (!levels.ended()) {
    const std::size_t count = levels.due().size();
    if (trials.outcomes.size() - row < count) break;
    performances.clear();
    for (std::size_t i = 0; i < count; ++i) performances.push_back(performance(trials.outcomes[row + i]));
    levels.take(performances);
    row += count;
  }
  if (!levels.ended() || row != trials.outcomes.size()) {
    throw std::invalid_argument("subset_levels: the trials are not those of a subset simulation");
  }
  return levels;
}

}  // namespace steerstat
