#include "study/recomputed.hpp"

#include <optional>
#include <stdexcept>
#include <string>

namespace steerstat {
namespace {

/// The first `first` of all rows and the first `failed` that did not converge, ascending, each once.
/// @param all_rows  whether the table has the rows of all finished trials
std::vector<std::uint64_t> rows_to_retain(const Retention& retention, const TrialTable& trials, bool all_rows) {
  std::vector<std::uint64_t> rows;
  std::uint64_t failures = 0;
  for (std::uint64_t row = 0; row < trials.outcomes.size(); ++row) {
    const bool failed = trials.outcomes[row].status != Status::converged;
    const bool first = (all_rows ? row : trials.index[row]) < retention.first;
    if (first || (failed && failures < retention.failed)) rows.push_back(row);
    failures += failed ? 1 : 0;
    if (!first && failures >= retention.failed) break;
  }
  return rows;
}

}  // namespace

std::vector<StudyResult::Retained> retained_trajectories(const Study& study, const Plan& plan, const TrialTable& trials,
                                                         const RunOptions& options, const ForEach& for_each) {
  const std::vector<std::uint64_t> rows = rows_to_retain(study.retention, trials, study.store == Store::all);
  std::vector<StudyResult::Retained> retained(rows.size());
  for_each(rows.size(), [&](std::size_t i) {
    Turnstile::Turn turn(options.turns);
    const std::uint64_t index = trials.index[rows[i]];
    retained[i] = {index,
                   replay(plan.parameters(index), study.integrator, 0.05, 0, [&] { check_in(turn, options.give_up); })};
    if (!same_bits(retained[i].trajectory.outcome, trials.outcomes[rows[i]])) {
      throw std::logic_error("the replay of trial " + std::to_string(index) + " ended differently from its run");
    }
  });
  return retained;
}

std::vector<std::uint64_t> trials_to_audit(const Study& study, const TrialTable& trials) {
  std::vector<std::uint64_t> indices = rows_to_audit(study.sampling.seed, study.audited_trials, trials.index.size());
  for (std::uint64_t& row : indices) row = trials.index[row];
  return indices;
}

Audit audit_of(const Study& study, const Plan& plan, std::span<const std::uint64_t> indices, const RunOptions& options,
               const ForEach& for_each) {
  const IntegratorChoice auditor = auditor_of(study.integrator);
  std::vector<std::optional<AuditedTrial>> finished(indices.size());
  for_each(indices.size(), [&](std::size_t i) {
    Turnstile::Turn turn(options.turns);
    if (options.stop.stop_requested()) return;
    const std::uint64_t index = indices[i];
    const auto runner = make_runner(auditor);
    finished[i] = audited(index, runner->run(plan.parameters(index), [&] { check_in(turn, options.give_up); }));
  });
  Audit audit{auditor.tolerance, {}};
  for (const std::optional<AuditedTrial>& trial : finished) {
    if (trial) audit.trials.push_back(*trial);
  }
  return audit;
}

}  // namespace steerstat
