#include "report/rare_failures_json.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "report/number_json.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::ordered_json;

void append(Json& json, const WeightedFailures& found) {
  json["failures"] = found.failures;
  json["effective_failures"] = found.effective_failures;
  json["largest_share"] = found.largest_share;
  json["mean_weight"] = found.mean_weight;
  json["effective_draws"] = found.effective_draws;
}

void append(Json& json, const SubsetFailures& found) {
  static constexpr std::array<std::string_view, 3> ends{"failure", "levels", "stagnation"};
  json["ended"] = ends[static_cast<std::size_t>(found.end)];
  json["coefficient_of_variation"] = found.found.variation;
  json["levels"] = Json::array();
  for (const SubsetLevel& level : found.levels) {
    json["levels"].push_back({{"threshold", number_or_null(level.threshold)},
                              {"probability", level.probability},
                              {"failures", level.failures},
                              {"acceptance", number_or_null(level.acceptance)},
                              {"correlation", level.correlation},
                              {"coefficient_of_variation", level.variation}});
  }
}

}  // namespace

Json rare_failures_json(const std::optional<RareFailures>& rare) {
  if (!rare) return nullptr;
  const FailureRate rate = failure_rate(*rare);
  const auto& plain = rate.nominal_interval;
  Json json;
  json["method"] = std::holds_alternative<WeightedFailures>(rare->found) ? "importance" : "subset_simulation";
  json["failure_rate"] = {{"estimate", rate.estimate}, {"standard_error", rate.standard_error},
                          {"ci_low", rate.low},        {"ci_high", rate.high},
                          {"level", rare->level},      {"method", interval_method(*rare)}};
  json["trusted"] = rate.trusted;
  json["reason"] = rate.reason;
  std::visit([&](const auto& found) { append(json, found); }, rare->found);
  json["nominal"] = {{"trials", rate.nominal.trials},
                     {"failures", rate.nominal.successes},
                     {"ci_low", plain ? Json(plain->low) : Json(nullptr)},
                     {"ci_high", plain ? Json(plain->high) : Json(nullptr)}};
  return json;
}

}  // namespace steerstat
