#include "view/columns_json.hpp"
#include "view/comparison_view.hpp"

namespace steerstat {

using view_json::Json;

std::string comparison_view_json(const ComparisonView& view) {
  Json inputs = Json::array();
  for (const ComparisonView::SharedInput& input : view.inputs) {
    inputs.push_back({{"input", input.input}, {"unit", input.unit}});
  }
  const ComparisonView::Discordant& discordant = view.discordant;
  Json columns = Json::array();
  for (const std::vector<double>& column : discordant.inputs) columns.push_back(view_json::numbers(column));
  Json json;
  json["view"] = "comparison";
  json["version"] = view_version;
  json["comparison"] = Json::parse(comparison_json(view.comparison));
  json["settling_time"] = {{"a", view_json::distribution(view.a)},
                           {"b", view_json::distribution(view.b)},
                           {"difference", view_json::distribution(view.difference)}};
  json["inputs"] = std::move(inputs);
  json["discordant"] = {{"index", discordant.index},
                        {"status_a", view_json::statuses(discordant.status_a)},
                        {"status_b", view_json::statuses(discordant.status_b)},
                        {"settling_time", view_json::numbers(discordant.settling_time)},
                        {"inputs", std::move(columns)}};
  return view_json::text(json);
}

}  // namespace steerstat
