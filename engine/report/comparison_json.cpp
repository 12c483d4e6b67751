#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/comparison.hpp"
#include "report/number_json.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::ordered_json;

Json side_json(const Comparison::Side& side) {
  return {{"id", side.id},
          {"name", side.name},
          {"spec_sha256", side.spec_sha256},
          {"engine_version", side.engine_version},
          {"complete", side.complete},
          {"trials", {{"requested", side.requested}, {"completed", side.completed}}}};
}

Json differences_json(const std::vector<SpecDifference>& differences) {
  const auto value = [](const std::optional<std::string>& text) { return text ? Json::parse(*text) : Json(nullptr); };
  Json json = Json::array();
  for (const SpecDifference& difference : differences) {
    json.push_back({{"pointer", difference.pointer}, {"a", value(difference.a)}, {"b", value(difference.b)}});
  }
  return json;
}

Json success_json(const PairedStatistics& statistics) {
  const PairedCounts& counts = statistics.counts;
  const auto n = static_cast<double>(counts.pairs());
  const auto share = [&](std::uint64_t count) {
    return counts.pairs() > 0 ? Json(static_cast<double>(count) / n) : Json(nullptr);
  };
  Json difference = {{"estimate", nullptr}, {"ci_low", nullptr}, {"ci_high", nullptr}};
  if (const auto& interval = statistics.success_rate_difference) {
    difference = {{"estimate", interval->estimate}, {"ci_low", interval->low}, {"ci_high", interval->high}};
  } else if (counts.pairs() > 0) {
    difference["estimate"] = difference_of(counts);
  }
  difference["level"] = comparison_level;
  difference["method"] = "tango";
  return {{"a", share(counts.both + counts.a_only)},
          {"b", share(counts.both + counts.b_only)},
          {"difference", std::move(difference)}};
}

Json interval_json(double estimate, const SampleInterval& interval) {
  return {{"estimate", estimate},
          {"ci_low", number_or_null(interval.low)},
          {"ci_high", number_or_null(interval.high)},
          {"level", comparison_level}};
}

Json settling_json(const std::optional<SettlingTimeDifference>& difference) {
  if (!difference) return nullptr;
  const SampleStatistics& sample = difference->sample;
  return {{"pairs", difference->pairs},
          {"mean", interval_json(sample.mean, difference->mean)},
          {"median", interval_json(sample.p50, difference->median)},
          {"std", number_or_null(sample.std)},
          {"min", sample.min},
          {"p05", sample.p05},
          {"p95", sample.p95},
          {"max", sample.max}};
}

void append_statistics(Json& json, const PairedStatistics& statistics) {
  const PairedCounts& counts = statistics.counts;
  json["pairs"] = {{"total", counts.pairs()},
                   {"both", counts.both},
                   {"a_only", counts.a_only},
                   {"b_only", counts.b_only},
                   {"neither", counts.neither}};
  json["success_rate"] = success_json(statistics);
  json["mcnemar"] = nullptr;
  if (statistics.test) {
    json["mcnemar"] = {{"p_value", statistics.test->p_value}, {"mid_p_value", statistics.test->mid_p_value}};
    json["mcnemar"]["holm_p_value"] = number_or_null(statistics.holm_p_value);
  }
  json["settling_time_difference"] = settling_json(statistics.settling_time_difference);
}

Json discordant_json(const DiscordantTrials& trials) {
  return {{"count", trials.count}, {"indices", trials.indices}};
}

}  // namespace

std::string comparison_json(const Comparison& comparison) {
  Json json;
  json["a"] = side_json(comparison.a);
  json["b"] = side_json(comparison.b);
  json["warnings"] = comparison.warnings;
  json["differences"] = differences_json(comparison.differences);
  json["drawn"] = comparison.drawn;
  append_statistics(json, comparison.all);
  json["cells"] = Json::array();
  for (const Comparison::Cell& cell : comparison.cells) {
    Json of_cell;
    of_cell["sweep"] = Json::object();
    for (const Plan::SweptValue& swept : cell.sweep) of_cell["sweep"][swept.name] = swept.value;
    append_statistics(of_cell, cell.statistics);
    json["cells"].push_back(std::move(of_cell));
  }
  json["discordant"] = {{"a_only", discordant_json(comparison.a_only)}, {"b_only", discordant_json(comparison.b_only)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace steerstat
