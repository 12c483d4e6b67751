#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/status.hpp"
#include "trial/replay.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// A finished trial.
struct TrialRow {
  std::uint64_t index{0};
  std::uint64_t cell{0};
  std::vector<double> values;  ///< (varying) of the inputs that vary
  TrialOutcome outcome;
};

/// Which trials a reader wants.
struct TrialFilter {
  std::optional<Status> status;
  std::optional<std::uint64_t> cell;
};

/// Some of a study's finished trials, by rising index.
struct TrialPage {
  std::vector<std::string> names;  ///< (varying) of the inputs that vary
  std::vector<TrialRow> rows;
  std::optional<std::uint64_t> next;  ///< the first index of the next page; nothing at the end
  std::uint64_t revision{0};          ///< of the study when it was read
};

/// A trial computed again.
struct ReplayedTrial {
  std::vector<std::string> names;  ///< (varying)
  std::vector<double> values;      ///< (varying)
  Trajectory trajectory;           ///< its outcome is the same bits as the run's
};

}  // namespace steerstat
