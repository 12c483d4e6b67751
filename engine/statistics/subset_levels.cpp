#include "statistics/subset_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "core/normal.hpp"

namespace steerstat {
namespace {

constexpr double failure = std::numeric_limits<double>::infinity();

/// What the correlation along chains adds to the variance of a share [Au and Beck 2001]: 2 sum (1 - k / L)
/// rho(k).
///
/// @param reaches  (chains x length) whether a state counts, chain by chain
double chain_correlation(const std::vector<bool>& reaches, std::uint64_t length, double share) {
  const double variance = share * (1.0 - share);
  if (!(variance > 0.0)) return 0.0;
  double sum = 0.0;
  for (std::uint64_t lag = 1; lag < length; ++lag) {
    std::uint64_t both = 0;
    std::uint64_t pairs = 0;
    for (std::uint64_t begin = 0; begin < reaches.size(); begin += length) {
      for (std::uint64_t i = begin; i + lag < begin + length; ++i) both += reaches[i] && reaches[i + lag] ? 1U : 0U;
      pairs += length - lag;
    }
    const double covariance = static_cast<double>(both) / static_cast<double>(pairs) - share * share;
    sum += 2.0 * (1.0 - static_cast<double>(lag) / static_cast<double>(length)) * covariance / variance;
  }
  return std::max(sum, 0.0);
}

std::string distrust(const SubsetLevels& levels, double variation) {
  const auto stands_still = [](const SubsetLevel& level) {
    return level.acceptance && *level.acceptance < SubsetEstimate::least_trusted_acceptance;
  };
  if (std::any_of(levels.levels().begin(), levels.levels().end(), stands_still)) {
    return "the chains hardly move, as performance is too rough for their steps; they have seen little but their seeds";
  }
  if (levels.end() == SubsetEnd::levels) {
    return "the last level allowed did not reach failure; allow more levels";
  }
  if (levels.end() == SubsetEnd::stagnation) {
    return "the levels rise no further and have not reached failure: it may lie beyond a gap that chains do not cross";
  }
  return variation > SubsetEstimate::largest_trusted_variation ? "the estimate varies too much; run more trials a level"
                                                               : "";
}

}  // namespace

SubsetLevels::SubsetLevels(std::uint64_t states, std::uint64_t most_levels)
    : states_(states), most_levels_(most_levels), due_(states) {
  if (states == 0 || states % chain_length != 0 || most_levels == 0) {
    throw std::invalid_argument("SubsetLevels: needs a positive multiple of 10 states, and a level");
  }
}

void SubsetLevels::take(std::span<const double> performances) {
  if (performances.size() != due_.size()) throw std::invalid_argument("SubsetLevels: takes what is due");
  const std::uint64_t first = performances_.size();
  performances_.insert(performances_.end(), performances.begin(), performances.end());
  if (first == 0) {
    chains_.resize(states_);
    std::iota(chains_.begin(), chains_.end(), std::uint64_t{0});
    finish_level();
    nominal_ = {levels_.front().failures, states_};
    return;
  }
  for (std::uint64_t chain = 0; chain < due_.size(); ++chain) {
    const bool stays = performances_[first + chain] >= *threshold_;
    accepted_ += stays ? 1U : 0U;
    const std::uint64_t state = stays ? first + chain : *due_[chain];
    chains_[chain * chain_length + step_] = state;
    due_[chain] = state;
  }
  if (++step_ == chain_length) finish_level();
}

void SubsetLevels::finish_level() {
  const auto worse = [&](std::uint64_t a, std::uint64_t b) { return performances_[a] > performances_[b]; };
  std::vector<std::uint64_t> order = chains_;
  std::stable_sort(order.begin(), order.end(), worse);
  const std::uint64_t seeds = states_ / chain_length;
  const auto fails = [&](std::uint64_t row) { return performances_[row] == failure; };
  const auto failures = static_cast<std::uint64_t>(std::count_if(order.begin(), order.end(), fails));
  const bool reached = failures >= seeds;
  // Half way between the states that begin chains and the others, where there is room.
  const double next = reached ? failure : 0.5 * (performances_[order[seeds - 1]] + performances_[order[seeds]]);
  const bool stagnates = !reached && threshold_ && !(next > *threshold_);
  const bool is_last = reached || stagnates || levels_.size() + 1 == most_levels_;

  SubsetLevel level{};
  if (!is_last) level.threshold = next;
  level.failures = failures;
  std::vector<bool> reaches(chains_.size());
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    reaches[i] = is_last ? fails(chains_[i]) : performances_[chains_[i]] >= next;
  }
  const auto n = static_cast<double>(states_);
  level.probability = static_cast<double>(std::count(reaches.begin(), reaches.end(), true)) / n;
  if (!levels_.empty()) {
    level.acceptance = static_cast<double>(accepted_) / static_cast<double>(states_ - seeds);
    level.correlation = chain_correlation(reaches, chain_length, level.probability);
  }
  if (level.probability > 0.0) {
    level.variation = std::sqrt((1.0 - level.probability) / (level.probability * n) * (1.0 + level.correlation));
  }
  levels_.push_back(level);
  if (is_last) {
    end_ = reached ? SubsetEnd::failure : (stagnates ? SubsetEnd::stagnation : SubsetEnd::levels);
    due_.clear();
    return;
  }
  order.resize(seeds);
  begin_chains(order, next);
}

void SubsetLevels::begin_chains(const std::vector<std::uint64_t>& seeds, double threshold) {
  threshold_ = threshold;
  due_.assign(seeds.begin(), seeds.end());
  for (std::uint64_t chain = 0; chain < seeds.size(); ++chain) chains_[chain * chain_length] = seeds[chain];
  step_ = 1;  // a chain's first state is its seed, which is in the level and distributed as it [Au and Beck 2001]
  accepted_ = 0;
}

std::uint64_t SubsetLevels::level_of(std::uint64_t row) const {
  return row < states_ ? 0 : 1 + (row - states_) / (states_ - states_ / chain_length);
}

SubsetEstimate subset_estimate(const SubsetLevels& levels, double level) {
  if (!levels.ended()) throw std::invalid_argument("subset_estimate: the simulation has not ended");
  SubsetEstimate found;
  found.nominal = levels.nominal();
  found.nominal_interval = clopper_pearson_interval(found.nominal.successes, found.nominal.trials, level);
  found.estimate = 1.0;
  for (const SubsetLevel& each : levels.levels()) {
    found.estimate *= each.probability;
    found.variation += each.variation;
  }
  found.reason = distrust(levels, found.variation);
  found.trusted = found.reason.empty();
  found.low = found.nominal_interval.low;
  found.high = found.nominal_interval.high;
  if (found.trusted) {
    const double spread = std::sqrt(std::log1p(found.variation * found.variation));  // of the logarithm
    const double factor = std::exp(-normal_quantile((1.0 - level) / 2.0) * spread);
    found.low = found.estimate / factor;
    found.high = std::min(found.estimate * factor, 1.0);
  }
  return found;
}

}  // namespace steerstat
