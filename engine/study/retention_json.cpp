#include "study/retention_json.hpp"

#include <array>

#include "study/limits.hpp"

namespace steerstat {

Retention decode_retention(const Reader& reader) {
  static constexpr std::array<std::string_view, 1> known{"trajectories"};
  static constexpr std::array<std::string_view, 2> known_below{"failed", "first"};
  Retention retention;
  if (!reader.require_object("an object {\"trajectories\"}")) return retention;
  reader.refuse_unknown_keys(known);
  const auto trajectories = reader.find("trajectories");
  if (!trajectories || !trajectories->require_object("an object {\"failed\", \"first\"}")) return retention;
  trajectories->refuse_unknown_keys(known_below);
  if (const auto failed = trajectories->find("failed")) {
    retention.failed = failed->integer(0, most_trajectories).value_or(0);
  }
  if (const auto first = trajectories->find("first")) {
    retention.first = first->integer(0, most_trajectories).value_or(0);
  }
  return retention;
}

}  // namespace steerstat
