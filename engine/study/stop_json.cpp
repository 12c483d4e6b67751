#include "study/stop_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "study/intervals_json.hpp"
#include "study/limits.hpp"
#include "study/rate.hpp"
#include "study/unmeasured_json.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

constexpr Range quantiles{.low = 0.0, .high = 1.0, .rule = "in (0, 1)"};
constexpr Range rate_half_widths{.low = 0.0, .high = 0.5, .rule = "in (0, 0.5)"};
constexpr Range half_widths{.low = 0.0, .rule = "> 0"};
constexpr Range relative_half_widths{.low = 0.0, .high = 1.0, .rule = "in (0, 1)"};

std::vector<std::string_view> estimated_names() {
  std::vector<std::string_view> names(rate_names().begin(), rate_names().end());
  for (const Metric& metric : metrics()) names.push_back(metric.name);
  return names;
}

void decode_width(const Reader& reader, bool is_rate, PrecisionGoal& goal) {
  const auto absolute = reader.find("half_width");
  const auto relative = reader.find("relative_half_width");
  if (absolute && relative) {
    relative->fail("\"half_width\" and \"relative_half_width\" (one measure of precision); remove one of them");
  } else if (absolute) {
    goal.half_width = absolute->number_in(is_rate ? rate_half_widths : half_widths, "half_width").value_or(0.0);
  } else if (relative) {
    goal.half_width = relative->number_in(relative_half_widths, "relative_half_width").value_or(0.0);
    goal.relative = true;
  } else {
    reader.fail(
        "no precision is asked for (half_width or relative_half_width); add one, such as \"half_width\": 0.005");
  }
}

PrecisionGoal decode_goal(const Reader& reader, bool measured) {
  PrecisionGoal goal;
  if (!reader.require_object("an object {\"metric\", \"half_width\"}")) return goal;
  static constexpr std::array<std::string_view, 4> known{"metric", "quantile", "half_width", "relative_half_width"};
  reader.refuse_unknown_keys(known);
  const std::vector<std::string_view> names = estimated_names();
  const auto metric = reader.require("metric");
  const auto position = metric ? metric->one_of(names) : std::nullopt;
  if (!position) return goal;
  goal.metric = names[*position];
  if (!measured) refuse_unmeasured(*metric, goal.metric);
  const bool is_rate = outcome_of_rate(goal.metric).has_value();
  const auto quantile = reader.find("quantile");
  if (is_rate && quantile) {
    quantile->fail(fmt::format("{} has no quantiles (a rate is one number); remove it", goal.metric));
  } else if (quantile) {
    goal.quantile = quantile->number_in(quantiles, "quantile");
  } else if (!is_rate) {
    reader.fail(
        fmt::format("\"quantile\" is missing ({} differs from trial to trial); add it, such as 0.95", goal.metric));
  }
  decode_width(reader, is_rate, goal);
  return goal;
}

void decode_goals(const Reader& reader, bool measured, StopRule& rule) {
  if (!reader.require_array("an array of goals {\"metric\", \"half_width\"}")) return;
  const std::size_t size = reader.value().size();
  if (size == 0 || size > most_precision_goals) {
    reader.fail(fmt::format("{} goals (1 to {}); {}", size, most_precision_goals,
                            size == 0 ? "ask for at least one" : "keep those that matter"));
    return;
  }
  for (std::size_t i = 0; i < size; ++i) rule.until.push_back(decode_goal(reader.element(i), measured));
}

/// Checks the counts of draws against each other and against the sampling.
void decode_counts(const Reader& reader, Sampling& sampling, bool trials_are_given, StopRule& rule) {
  const auto count = [&](std::string_view key) {
    const auto member = reader.find(key);
    return member ? member->integer(1, most_trials) : std::nullopt;
  };
  const auto max_trials = count("max_trials");
  const auto min_trials = count("min_trials");
  rule.check_every = count("check_every").value_or(rule.check_every);
  if (max_trials && trials_are_given && *max_trials > sampling.trials) {
    reader.find("max_trials")
        ->fail(fmt::format("max_trials {} is above the sampling's {} trials (max_trials <= trials, which are the most "
                           "a study takes); raise those, or leave max_trials out",
                           *max_trials, sampling.trials));
    return;
  }
  const std::uint64_t most = max_trials.value_or(sampling.trials);
  if (min_trials && *min_trials > most) {
    reader.find("min_trials")
        ->fail(fmt::format("min_trials {} is above {}, the most draws that the study takes (min_trials <= "
                           "max_trials, or the sampling's trials); lower it, or raise those",
                           *min_trials, most));
    return;
  }
  sampling.trials = most;
  rule.min_trials = min_trials.value_or(std::min(rule.check_every, most));
}

}  // namespace

std::optional<StopRule> decode_stop(const Reader& reader, Sampling& sampling, bool trials_are_given, bool measured) {
  if (!reader.require_object("an object {\"until\", \"check_every\", ...}")) return std::nullopt;
  const std::size_t mistakes = reader.errors().size();
  static constexpr std::array<std::string_view, 5> known{"min_trials", "max_trials", "check_every", "level", "until"};
  reader.refuse_unknown_keys(known);
  StopRule rule;
  if (const auto level = reader.find("level")) {
    rule.level = level->number_in(confidence_levels, "stop.level").value_or(rule.level);
  }
  if (const auto until = reader.require("until")) decode_goals(*until, measured, rule);
  decode_counts(reader, sampling, trials_are_given, rule);
  if (reader.errors().size() != mistakes) return std::nullopt;
  return rule;
}

nlohmann::json encode_stop(const StopRule& rule) {
  nlohmann::json object{{"min_trials", rule.min_trials}, {"check_every", rule.check_every}, {"level", rule.level}};
  object["until"] = nlohmann::json::array();
  for (const PrecisionGoal& goal : rule.until) {
    nlohmann::json entry{{"metric", goal.metric}};
    if (goal.quantile) entry["quantile"] = *goal.quantile;
    entry[goal.relative ? "relative_half_width" : "half_width"] = goal.half_width;
    object["until"].push_back(std::move(entry));
  }
  return object;
}

}  // namespace steerstat
