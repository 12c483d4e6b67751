#include "view/success_map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"
#include "study/nearest.hpp"
#include "view/study_columns.hpp"

namespace steerstat {
namespace {

std::size_t position_of(std::string_view name, const std::vector<std::string>& varying) {
  const auto found = std::find(varying.begin(), varying.end(), name);
  if (found != varying.end()) return static_cast<std::size_t>(found - varying.begin());
  const std::vector<std::string_view> known(varying.begin(), varying.end());
  const auto meant = nearest(name, known);
  throw NoSuchAxis(fmt::format("{} does not vary in this study (an axis must vary); {}", name,
                               meant             ? fmt::format("did you mean {}?", *meant)
                               : varying.empty() ? "nothing does"
                                                 : fmt::format("these do: {}", fmt::join(varying, ", "))));
}

}  // namespace

MapMaker::MapMaker(const ViewedStudy& viewed, std::size_t bins)
    : viewed_(viewed),
      plan_(viewed.study),
      identity_(identity_of(viewed.study)),
      bins_(bins),
      rows_(rows_that_count(plan_, viewed.result.trials)),
      converged_(converged_among(viewed.result.trials, rows_)),
      binned_(plan_.varying().size()) {}

const MapMaker::Binned& MapMaker::binned(std::size_t input) {
  if (!binned_[input]) {
    const std::vector<double> values = values_of(viewed_.parameters[input], rows_);
    const VaryingInput varying = varying_input(viewed_.study, plan_.varying()[input]);
    Axis axis = axis_of(*varying.input, varying.listed, values, bins_);
    std::vector<std::uint16_t> bins = bin_numbers(axis, values);
    binned_[input] = Binned{std::move(axis), std::move(bins)};
  }
  return *binned_[input];
}

SuccessMap MapMaker::map(std::size_t x, std::size_t y) {
  if (rows_.empty()) throw BadUsage("the study has no finished trials; there is no map of none");
  const Binned& along_x = binned(x);
  const Binned& along_y = binned(y);
  return {identity_, along_x.axis, along_y.axis, rows_.size(),
          count_bins(along_x.axis.bins(), along_x.bins, along_y.axis.bins(), along_y.bins, converged_)};
}

SuccessMap success_map(const ViewedStudy& viewed, std::string_view x, std::string_view y) {
  const Plan plan(viewed.study);
  const std::size_t along_x = position_of(x, plan.varying());
  const std::size_t along_y = position_of(y, plan.varying());
  if (along_x == along_y) throw BadUsage(fmt::format("{} is on both axes (a map is of two inputs); choose another", x));
  return MapMaker(viewed).map(along_x, along_y);
}

}  // namespace steerstat
