#include "sampling/importance.hpp"

#include <algorithm>
#include <utility>

#include "core/elementary.hpp"
#include "core/normal.hpp"
#include "sampling/normal_probability.hpp"

namespace steerstat {
namespace {

const ProposalDensity::Tilt* tilt_of(const ProposalDensity* component, std::size_t variable) {
  if (component == nullptr) return nullptr;
  for (const ProposalDensity::Tilt& tilt : component->tilts) {
    if (tilt.variable == variable) return &tilt;
  }
  return nullptr;
}

}  // namespace

Importance::Importance(std::uint64_t seed, std::span<const std::string> names, std::vector<ProposalDensity> components)
    : choice_(seed, "sampling.proposal"), components_(std::move(components)), nominal_share_(1.0) {
  streams_.reserve(names.size());
  for (const std::string& name : names) streams_.emplace_back(seed, name);
  for (const ProposalDensity& component : components_) nominal_share_ -= component.share;
}

/// @return null for the nominal one
const ProposalDensity* Importance::component_of(std::uint64_t draw) const {
  double u = choice_.at(draw) - nominal_share_;
  if (u < 0.0) return nullptr;
  for (const ProposalDensity& component : components_) {
    u -= component.share;
    if (u < 0.0) return &component;
  }
  return components_.empty() ? nullptr : &components_.back();  // where rounding leaves a rest
}

double Importance::normal(std::uint64_t draw, std::size_t variable, const ProposalDensity* component) const {
  const double z = normal_quantile(streams_[variable].at(draw));
  const ProposalDensity::Tilt* tilt = tilt_of(component, variable);
  return tilt == nullptr ? z : tilt->shift + tilt->scale * z;
}

double Importance::coordinate(std::uint64_t draw, std::size_t variable) const {
  const ProposalDensity* component = component_of(draw);
  if (tilt_of(component, variable) == nullptr) return streams_[variable].at(draw);
  return coordinate_of_normal(normal(draw, variable, component));
}

void Importance::place(std::uint64_t draw, std::span<double> point) const {
  for (std::size_t variable = 0; variable < point.size(); ++variable) point[variable] = streams_[variable].at(draw);
  const ProposalDensity* component = component_of(draw);
  if (component == nullptr) return;
  for (const ProposalDensity::Tilt& tilt : component->tilts) {
    point[tilt.variable] = coordinate_of_normal(normal(draw, tilt.variable, component));
  }
}

double Importance::weight(std::uint64_t draw) const {
  const ProposalDensity* drawn_from = component_of(draw);
  double mixture = nominal_share_;  // over the nominal density
  for (const ProposalDensity& component : components_) {
    double exponent = 0.0;
    double scale = 1.0;
    for (const ProposalDensity::Tilt& tilt : component.tilts) {
      const double z = normal(draw, tilt.variable, drawn_from);
      const double y = (z - tilt.shift) / tilt.scale;
      exponent += 0.5 * (z * z - y * y);
      scale *= tilt.scale;
    }
    mixture += component.share * exponential(exponent) / scale;
  }
  return 1.0 / mixture;
}

}  // namespace steerstat
