#include <nlohmann/json.hpp>

#include "report/approximation_summary.hpp"
#include "report/number_json.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::ordered_json;

Json cell_json(const ApproximationSummary::Cell& cell) {
  Json json = {{"sweep", Json::object()}, {"errors", Json::object()}};
  for (std::size_t i = 0; i < cell.sweep.size(); ++i) {
    if (cell.sweep[i]) json["sweep"][std::string(cycle_definitions()[i].name)] = *cell.sweep[i];
  }
  for (std::size_t m = 0; m < error_measure_count; ++m) {
    const SampleStatistics& error = cell.errors[m];
    json["errors"][std::string(error_measures()[m].name)] = {{"mean", error.mean}, {"p05", error.p05},
                                                             {"p50", error.p50},   {"p95", error.p95},
                                                             {"p99", error.p99},   {"max", error.max}};
  }
  return json;
}

Json order_json(const std::optional<FittedOrder>& order) {
  if (!order) return nullptr;
  return {{"draws", order->draws},
          {"mean", order->mean},
          {"standard_error", number_or_null(order->standard_error)},
          {"ci_low", number_or_null(order->interval.low)},
          {"ci_high", number_or_null(order->interval.high)},
          {"level", approximation_level},
          {"p05", order->p05},
          {"p50", order->p50},
          {"p95", order->p95}};
}

}  // namespace

std::string approximation_json(const ApproximationSummary& summary) {
  Json json;
  json["study"] = {{"kind", "approximation"},
                   {"name", summary.name},
                   {"engine_version", summary.engine_version},
                   {"seed", summary.seed}};
  json["coupling"] = summary.coupling;
  json["tolerance"] = summary.tolerance;
  json["draws"] = summary.draws;
  json["cells"] = Json::array();
  for (const ApproximationSummary::Cell& cell : summary.cells) json["cells"].push_back(cell_json(cell));
  json["orders"] = Json::object();
  for (std::size_t m = 0; m < error_measure_count; ++m) {
    const ApproximationSummary::Orders& orders = summary.orders[m];
    json["orders"][std::string(error_measures()[m].name)] = {{"amplitude", order_json(orders.amplitude)},
                                                             {"period", order_json(orders.period)},
                                                             {"dilation", order_json(orders.dilation)}};
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace steerstat
