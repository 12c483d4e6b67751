#include "study/intervals_json.hpp"

#include <fmt/format.h>

#include <array>

namespace steerstat {

IntervalChoice decode_intervals(const Reader& reader, bool stops) {
  IntervalChoice intervals = default_intervals(stops);
  if (!reader.require_object("an object {\"method\", \"level\"}")) return intervals;
  static constexpr std::array<std::string_view, 2> known{"method", "level"};
  reader.refuse_unknown_keys(known);
  if (const auto level = reader.find("level")) {
    intervals.level = level->number_in(confidence_levels, "intervals.level").value_or(intervals.level);
  }
  const auto method = reader.find("method");
  const auto position = method ? method->one_of(proportion_method_names) : std::nullopt;
  if (!position) return intervals;
  const auto chosen = static_cast<ProportionMethod>(*position);
  if (stops && chosen != ProportionMethod::confidence_sequence) {
    method->fail(
        fmt::format("{} beside \"stop\" (it holds for a number of trials fixed in advance, not for one decided by "
                    "looking at them); leave the method out, or write confidence_sequence",
                    proportion_method_names[*position]));
    return intervals;
  }
  intervals.method = chosen;
  return intervals;
}

nlohmann::json encode_intervals(const IntervalChoice& intervals, bool stops) {
  const IntervalChoice usual = default_intervals(stops);
  nlohmann::json object;
  if (intervals.level != usual.level) object["level"] = intervals.level;
  if (intervals.method != usual.method) {
    object["method"] = proportion_method_names[static_cast<std::size_t>(intervals.method)];
  }
  return object;
}

}  // namespace steerstat
