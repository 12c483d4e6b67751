#include "study/integrator_json.hpp"

#include <array>

namespace steerstat {
namespace {

constexpr Range integrator_tolerance{
    .low = 1e-14, .high = 1e-2, .includes_low = true, .includes_high = true, .rule = "in [1e-14, 0.01]"};

}  // namespace

void decode_integrator(const Reader& reader, IntegratorChoice& integrator) {
  if (!reader.require_object("an object {\"method\", \"tolerance\"}")) return;
  static constexpr std::array<std::string_view, 2> known{"method", "tolerance"};
  reader.refuse_unknown_keys(known);
  if (const auto method = reader.find("method")) {
    const auto position = method->one_of(IntegratorChoice::method_names);
    if (position) integrator.method = static_cast<IntegratorChoice::Method>(*position);
  }
  if (const auto tolerance = reader.find("tolerance")) {
    integrator.tolerance =
        tolerance->number_in(integrator_tolerance, "integrator.tolerance").value_or(integrator.tolerance);
  }
}

}  // namespace steerstat
