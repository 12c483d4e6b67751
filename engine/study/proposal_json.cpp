#include "study/proposal_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "study/limits.hpp"

namespace steerstat {
namespace {

// A weight is bounded by 1 / nominal, and what the nominal draws alone say bounds the rate whatever the components
// miss.
constexpr Range nominal_range{.low = 0.1, .high = 1.0, .includes_low = true, .rule = ">= 0.1 and < 1"};
constexpr Range share_range{.low = 0.0, .rule = "> 0"};
// Beyond these the components lie where the distributions hold no probability that a double tells from 0.
constexpr Range shift_range{
    .low = -6.0, .high = 6.0, .includes_low = true, .includes_high = true, .rule = "in [-6, 6] standard deviations"};
constexpr Range scale_range{
    .low = 0.1, .high = 4.0, .includes_low = true, .includes_high = true, .rule = "in [0.1, 4]"};

class ProposalDecoder {
 public:
  ProposalDecoder(std::span<const Input> inputs, std::span<const std::string> mistaken)
      : inputs_(inputs), mistaken_(mistaken) {}

  [[nodiscard]] Proposal::Component component(const Reader& reader) const {
    static constexpr std::array<std::string_view, 2> known{"share", "inputs"};
    Proposal::Component component;
    if (!reader.require_object("an object {\"share\", \"inputs\"}")) return component;
    reader.refuse_unknown_keys(known);
    if (const auto share = reader.find("share")) {
      component.share = share->number_in(share_range, "a component's share").value_or(component.share);
    }
    if (const auto tilts = reader.require("inputs")) component.tilts = this->tilts(*tilts);
    return component;
  }

 private:
  /// In the order of the inputs, so that a study does not depend on how its proposal was written.
  [[nodiscard]] std::vector<Proposal::Tilt> tilts(const Reader& reader) const {
    std::vector<Proposal::Tilt> tilts;
    if (!reader.require_object("an object {\"plant.f2\": {\"shift\", \"scale\"}, ...}")) return tilts;
    if (reader.value().empty()) {
      reader.fail("the component moves no input (at least one; the nominal draws are a share of their own); name one");
    }
    std::vector<std::string_view> drawn;
    for (const Input& input : inputs_) {
      const auto member = reader.find(input.name);
      const bool is_drawn = std::holds_alternative<Distribution>(input.value);
      const bool unsure = std::find(mistaken_.begin(), mistaken_.end(), input.name) != mistaken_.end();
      if (is_drawn || unsure || member) drawn.emplace_back(input.name);
      if (!member) continue;
      if (is_drawn || unsure) {
        tilts.push_back(tilt(*member, input.name));
      } else {
        member->fail(
            fmt::format("{} is not drawn (a proposal is of what distributions draw); give it a distribution, "
                        "or remove it here",
                        input.name));
      }
    }
    reader.refuse_unknown_keys(drawn);
    return tilts;
  }

  static Proposal::Tilt tilt(const Reader& reader, const std::string& input) {
    static constexpr std::array<std::string_view, 2> known{"shift", "scale"};
    Proposal::Tilt tilt{input};
    if (!reader.require_object("an object {\"shift\", \"scale\"}")) return tilt;
    reader.refuse_unknown_keys(known);
    if (const auto shift = reader.find("shift")) tilt.shift = shift->number_in(shift_range, "a shift").value_or(0.0);
    if (const auto scale = reader.find("scale")) tilt.scale = scale->number_in(scale_range, "a scale").value_or(1.0);
    return tilt;
  }

  std::span<const Input> inputs_;
  std::span<const std::string> mistaken_;
};

}  // namespace

Proposal decode_proposal(const Reader& reader, std::span<const Input> inputs, std::span<const std::string> mistaken) {
  static constexpr std::array<std::string_view, 2> known{"nominal", "components"};
  Proposal proposal;
  if (!reader.require_object("an object {\"nominal\", \"components\"}")) return proposal;
  reader.refuse_unknown_keys(known);
  if (const auto nominal = reader.find("nominal")) {
    proposal.nominal = nominal->number_in(nominal_range, "the nominal share").value_or(proposal.nominal);
  }
  const auto components = reader.find("components");
  if (!components) {
    proposal.components = default_proposal(inputs).components;
    return proposal;
  }
  if (!components->require_array("an array of components [{\"inputs\": {...}}, ...]")) return proposal;
  const std::size_t size = components->value().size();
  if (size == 0 || size > most_proposal_components) {
    components->fail(fmt::format("{} components (1 to {}); {}", size, most_proposal_components,
                                 size == 0 ? "give one, or leave them out for the default" : "remove some"));
    return proposal;
  }
  const std::size_t mistakes = reader.errors().size();
  const ProposalDecoder decoder(inputs, mistaken);
  for (std::size_t i = 0; i < size; ++i) proposal.components.push_back(decoder.component(components->element(i)));
  if (reader.errors().size() != mistakes) proposal.components.clear();
  return proposal;
}

Proposal default_proposal(std::span<const Input> inputs) {
  constexpr double wider = 1.5;
  Proposal::Component component;
  for (const Input& input : inputs) {
    if (std::holds_alternative<Distribution>(input.value)) component.tilts.push_back({input.name, 0.0, wider});
  }
  Proposal proposal;
  proposal.components.push_back(std::move(component));
  return proposal;
}

nlohmann::json encode_proposal(const Proposal& proposal) {
  auto components = nlohmann::json::array();
  for (const Proposal::Component& component : proposal.components) {
    auto inputs = nlohmann::json::object();
    for (const Proposal::Tilt& tilt : component.tilts) {
      inputs[tilt.input] = {{"shift", tilt.shift}, {"scale", tilt.scale}};
    }
    components.push_back({{"share", component.share}, {"inputs", std::move(inputs)}});
  }
  return {{"nominal", proposal.nominal}, {"components", std::move(components)}};
}

}  // namespace steerstat
