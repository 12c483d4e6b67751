#include "view/columns_json.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace steerstat::view_json {

Json number(double x, int digits) {
  if (!std::isfinite(x)) return nullptr;
  std::array<char, 40> text{};
  const auto end = fmt::format_to_n(text.data(), text.size(), "{:.{}e}", x, digits - 1).out;
  double rounded = x;
  std::from_chars(text.data(), end, rounded);
  if (rounded == 0.0) return 0;
  if (std::abs(rounded) < 1e6 && rounded == std::trunc(rounded)) return static_cast<int>(rounded);  // 3, not 3.0
  return rounded;
}

Json number_or_null(std::optional<double> x) {
  return x ? number(*x) : Json(nullptr);
}

Json numbers(std::span<const double> column, int digits) {
  Json json = Json::array();
  for (const double x : column) json.push_back(number(x, digits));
  return json;
}

Json statuses(std::span<const Status> column) {
  Json json = Json::array();
  for (const Status status : column) json.push_back(static_cast<int>(status));
  return json;
}

Json identity(const StudyIdentity& identity) {
  return {{"id", identity.id}, {"name", identity.name}};
}

Json axis(const Axis& axis) {
  // Edges and levels keep all their digits: a page may put trials into the same bins.
  return {{"input", axis.input},
          {"unit", axis.unit},
          {"edges", axis.levels.empty() ? Json(axis.edges) : Json(nullptr)},
          {"levels", axis.levels.empty() ? Json(nullptr) : Json(axis.levels)}};
}

Json distribution(const EmpiricalDistribution& distribution) {
  Json json = {{"metric", distribution.metric}, {"unit", distribution.unit},    {"trials", distribution.trials},
               {"x", numbers(distribution.x)},  {"f", numbers(distribution.f)}, {"band", nullptr},
               {"band_note", nullptr}};
  if (distribution.band) {
    json["band"] = {{"level", distribution.band->level}, {"half_width", distribution.band->half_width}};
  } else {
    json["band_note"] = distribution.band_note;
  }
  return json;
}

Json success_map(const SuccessMap& map) {
  return {{"view", "map"},
          {"version", view_version},
          {"study", identity(map.study)},
          {"x", axis(map.x)},
          {"y", axis(map.y)},
          {"of", map.of},
          {"outside", map.counts.outside},
          {"trials", map.counts.trials},
          {"successes", map.counts.successes}};
}

std::string text(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace steerstat::view_json
