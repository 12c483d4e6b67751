#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "view/viewed_study.hpp"

/// Columns of the trials that count.
namespace steerstat {

/// An input that varies, and whether explicit trials set it.
struct VaryingInput {
  const Input* input;  ///< of the study
  bool listed;
};

/// @param name  of Plan::varying()
VaryingInput varying_input(const Study& study, const std::string& name);

/// @return (rows) column[row] of each
std::vector<double> values_of(std::span<const double> column, std::span<const std::size_t> rows);

/// @return (rows) 1 where the trial converged, else 0
std::vector<std::uint8_t> converged_among(const TrialTable& trials, std::span<const std::size_t> rows);

/// At most `most` of the rows, rising: all, or a choice in which every set of so many is as likely, made by a hash of
/// the trials' indices, so that it does not fall in step with a design's own order.
std::vector<std::size_t> chosen_rows(const TrialTable& trials, std::span<const std::size_t> rows, std::size_t most);

}  // namespace steerstat
