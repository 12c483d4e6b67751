#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/study.hpp"
#include "trial/replay.hpp"

namespace steerstat {

/// How a trial ended, under the names a result file uses.
nlohmann::ordered_json outcome_json(const TrialOutcome& outcome);

/// A replayed trial as JSON: whose trial it is, what varied, how it ended, and its trajectory as columns under the
/// names a result file uses. Numbers read back to the same bits; those that are not finite are null.
///
/// @param names, values  (varying) what varied and its values in this trial
std::string trajectory_json(const Study& study, std::uint64_t index, const std::vector<std::string>& names,
                            const std::vector<double>& values, const Trajectory& trajectory);

}  // namespace steerstat
