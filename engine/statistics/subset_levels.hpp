#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "statistics/proportion.hpp"
#include "statistics/proportion_drop.hpp"

namespace steerstat {

/// What a level of a subset simulation came to.
struct SubsetLevel {
  std::optional<double> threshold;   ///< the performance from which on the next level lies; nothing where it is failure
  double probability;                ///< share of the level's states that reach the threshold, or that fail
  std::uint64_t failures;            ///< states that fail
  std::optional<double> acceptance;  ///< share of the candidates that stayed in the level; nothing in the first
  double correlation;                ///< gamma of [Au and Beck 2001], at least 0: what the chains' correlation adds
  double variation;                  ///< coefficient of variation of the probability
};

/// Why a subset simulation ended.
enum class SubsetEnd : std::uint8_t {
  failure,    ///< a tenth of the states failed
  levels,     ///< the last level allowed was not enough
  stagnation  ///< the threshold rose no more
};

/// Subset simulation [Au and Beck 2001]: the probability of failure as a product of conditional probabilities, each of
/// which is large. The states of the first level are independent draws; those of each further level are Markov chains
/// that begin at the tenth of the states with the worst performance, and stay beyond its best.
///
/// This is the bookkeeping: which state each chain is to leave next, and what the levels say. What a candidate is, and
/// how it performs, is the caller's. All that it decides follows from the performances in the order they come, so that
/// whoever has kept them can have it again. Performance is larger where it is worse, and infinite where it is failure.
class SubsetLevels {
 public:
  static constexpr std::uint64_t chain_length = 10;  ///< 1 / p0: a tenth of a level's states begin the next one's

  /// @param states       a level, a positive multiple of chain_length
  /// @param most_levels  > 0
  /// @throws std::invalid_argument outside those ranges
  SubsetLevels(std::uint64_t states, std::uint64_t most_levels);

  /// Where a candidate comes from: the evaluated one, counted from 0, that is its chain's state. Nothing where it is
  /// an independent draw.
  using Parent = std::optional<std::uint64_t>;

  /// Of the candidates to be evaluated next, in their order; empty at the end.
  [[nodiscard]] std::span<const Parent> due() const { return due_; }

  /// @param performances  of the candidates due, in their order
  /// @throws std::invalid_argument for another number of them
  void take(std::span<const double> performances);

  [[nodiscard]] bool ended() const { return end_.has_value(); }
  [[nodiscard]] const std::optional<SubsetEnd>& end() const { return end_; }
  [[nodiscard]] const std::vector<SubsetLevel>& levels() const { return levels_; }
  /// The independent draws: a plain sample.
  [[nodiscard]] const ProportionCount& nominal() const { return nominal_; }
  [[nodiscard]] std::uint64_t evaluated() const { return performances_.size(); }
  /// The level that the evaluated candidate `row` belongs to, from 0.
  [[nodiscard]] std::uint64_t level_of(std::uint64_t row) const;

 private:
  void finish_level();
  void begin_chains(const std::vector<std::uint64_t>& seeds, double threshold);

  std::uint64_t states_;
  std::uint64_t most_levels_;
  std::vector<double> performances_;  // (evaluated)
  std::vector<Parent> due_;
  std::vector<std::uint64_t> chains_;  // (states) evaluated rows, chain by chain
  std::uint64_t step_{0};              // of the chains
  std::uint64_t accepted_{0};          // candidates of the level
  std::optional<double> threshold_;    // of the level
  std::vector<SubsetLevel> levels_;
  std::optional<SubsetEnd> end_;
  ProportionCount nominal_{};
};

/// What a subset simulation says of the probability of failure.
///
/// - The estimate is the product of the levels' probabilities; its coefficient of variation the sum of theirs, the
/// upper
///   one of [Au and Beck 2001], as levels begin with states of those before. The interval is a lognormal's.
/// - The first level alone is a plain sample, whose exact interval [Clopper and Pearson 1934] holds whatever the chains
///   miss: failures that do not lie where performance is bad are as invisible to them as to it.
/// - The estimate is trusted where a tenth of the last level's states failed, at least `least_trusted_acceptance` of
/// each
///   level's candidates were accepted, as chains that stand still have seen little but their seeds, and the variation
///   is at most `largest_trusted_variation`. Where it is not, the interval is the first level's.
struct SubsetEstimate {
  static constexpr double least_trusted_acceptance = 0.1;
  static constexpr double largest_trusted_variation = 1.0;

  double estimate{0.0};
  double variation{0.0};  ///< coefficient of variation
  double low{0.0};        ///< of the interval that is to be relied on
  double high{1.0};
  ProportionCount nominal{};
  ProportionInterval nominal_interval{};
  bool trusted{false};
  std::string reason;  ///< why it is not trusted, one clause; empty where it is
};

/// @param levels  ended()
/// @param level   in (0, 1), of both intervals
SubsetEstimate subset_estimate(const SubsetLevels& levels, double level);

}  // namespace steerstat
