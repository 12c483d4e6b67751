#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "study/trial_range.hpp"
#include "study/trial_sketch.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// Finished trials, as columns in index order.
struct TrialTable {
  std::vector<std::uint64_t> index;    ///< (rows) ascending
  std::vector<TrialOutcome> outcomes;  ///< (rows)
};

/// What runs of a study finished before this one.
struct FinishedTrials {
  TrialTable trials;
  double wall_s{0.0};                   ///< [s] they took
  std::optional<TrialSketch> sketch{};  ///< of all finished trials, where the study does not keep all of their rows

  /// How many have finished, whether their rows are kept or not.
  [[nodiscard]] std::uint64_t count() const { return sketch ? sketch->count() : trials.index.size(); }

  /// Which, ascending.
  [[nodiscard]] std::vector<TrialRange> ranges() const { return sketch ? sketch->trials() : ranges_of(trials.index); }
};

/// Joins what two runs of a study finished: the trials of either, each once. Sketches that share some of their trials,
/// but neither all of the other's, do not add up: then those of the one with more, and of the other nothing.
FinishedTrials joined(FinishedTrials a, FinishedTrials b);

/// The trials of `range` alone, with indices counted from its begin. They took what all took.
FinishedTrials counted_from(TrialRange range, FinishedTrials finished);

/// Moves outcomes to the slots of their indices.
/// @return (trials) by index; those that the table does not have, as made by TrialOutcome's constructor
/// @throws std::invalid_argument where the table has an index of `trials` or beyond
std::vector<TrialOutcome> spread(TrialTable table, std::uint64_t trials);

/// The way back: the trials before `end`, and those after it that are `known`.
TrialTable gathered(std::vector<TrialOutcome> slots, std::uint64_t end, std::span<const TrialRange> known);

}  // namespace steerstat
