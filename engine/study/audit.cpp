#include "study/audit.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_set>

#include "sampling/stream.hpp"

namespace steerstat {

IntegratorChoice auditor_of(const IntegratorChoice& integrator) {
  constexpr double least_tolerance = 1e-12;
  return {IntegratorChoice::Method::cvode, std::max(integrator.tolerance / 100.0, least_tolerance), false};
}

std::vector<std::uint64_t> rows_to_audit(std::uint64_t seed, std::uint64_t wanted, std::uint64_t finished) {
  std::vector<std::uint64_t> rows(std::min(wanted, finished));
  if (rows.size() == finished) {
    std::iota(rows.begin(), rows.end(), std::uint64_t{0});
    return rows;
  }
  const UniformStream stream(seed, "audit");
  std::unordered_set<std::uint64_t> chosen;
  for (std::uint64_t k = 0; k < rows.size(); ++k) {
    const std::uint64_t last = finished - rows.size() + k;
    // In [0, last]: a draw is below 1 by at least 2^-53, and so is the product below last + 1.
    const auto drawn = static_cast<std::uint64_t>(stream.at(k) * static_cast<double>(last + 1));
    rows[k] = chosen.insert(drawn).second ? drawn : last;
    chosen.insert(rows[k]);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

AuditedTrial audited(std::uint64_t index, const TrialOutcome& reference) {
  return {index, reference.status, reference.cycles, reference.swings, reference.settling_time()};
}

bool agree(const AuditedTrial& reference, const TrialOutcome& outcome) {
  return reference.status == outcome.status && reference.cycles == outcome.cycles && reference.swings == outcome.swings;
}

}  // namespace steerstat
