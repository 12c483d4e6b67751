#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/status.hpp"
#include "trial/runner.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// What the reference integrator says of a trial.
struct AuditedTrial {
  std::uint64_t index{0};
  Status status{Status::integrator_failed};
  std::uint32_t cycles{0};
  std::uint32_t swings{0};
  double settling_time{std::numeric_limits<double>::quiet_NaN()};  ///< [s] NaN unless converged
};

/// Trials of a run computed again by the reference integrator.
struct Audit {
  double tolerance{0.0};             ///< of the reference integrator
  std::vector<AuditedTrial> trials;  ///< by index
};

/// The integrator that audits what `integrator` computed: SUNDIALS at a hundredth of the tolerance, but not below
/// 1e-12, where rounding sets the error of so many steps.
IntegratorChoice auditor_of(const IntegratorChoice& integrator);

/// Chooses rows without replacement, every subset equally likely [Bentley and Floyd 1987]: the same for the same
/// numbers, on whatever machine.
///
/// @param seed      the study's
/// @param wanted    rows to choose; all where there are no more
/// @param finished  rows to choose from, [0, finished)
/// @return ascending
std::vector<std::uint64_t> rows_to_audit(std::uint64_t seed, std::uint64_t wanted, std::uint64_t finished);

/// What an audit keeps of the reference's outcome of trial `index`.
AuditedTrial audited(std::uint64_t index, const TrialOutcome& reference);

/// Whether a run and its audit took a trial through the same course: the same status, cycles and swings.
bool agree(const AuditedTrial& reference, const TrialOutcome& outcome);

}  // namespace steerstat
