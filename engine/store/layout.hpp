#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "study/inputs.hpp"
#include "trial/trial.hpp"

/// Names and units of a result file (schemas/result_file.md), for its writer and its reader alike.
namespace steerstat::layout {

inline constexpr std::string_view filetype = "steerstat-study";
inline constexpr std::string_view shard_filetype = "steerstat-shard";
inline constexpr std::uint32_t format_version = 1;

/// The attribute `simd` of a run that used no instruction set of lockstep's.
inline constexpr std::string_view no_simd = "none";

/// A dataset of /trials that holds one number of the trial's outcome as it is.
template <class Number>
struct OutcomeColumn {
  const char* name;
  const char* units;
  Number& (*field)(TrialOutcome&);
};

inline constexpr OutcomeColumn<double> real_columns[] = {
    {"end_time", "s", [](TrialOutcome& o) -> double& { return o.end_time; }},
    {"passive_error", "rad, rad/s", [](TrialOutcome& o) -> double& { return o.passive_error; }},
    {"active_error", "m, m/s", [](TrialOutcome& o) -> double& { return o.active_error; }},
    {"q1", "m", [](TrialOutcome& o) -> double& { return o.end_state.q1; }},
    {"q2", "rad", [](TrialOutcome& o) -> double& { return o.end_state.q2; }},
    {"q1_dot", "m/s", [](TrialOutcome& o) -> double& { return o.end_state.q1_dot; }},
    {"q2_dot", "rad/s", [](TrialOutcome& o) -> double& { return o.end_state.q2_dot; }},
};

/// Metrics, which files from before there were any do not have: NaN then.
inline constexpr OutcomeColumn<double> metric_columns[] = {
    {"effort", "N^2 s", [](TrialOutcome& o) -> double& { return o.effort; }},
    {"peak_acceleration", "m/s^2", [](TrialOutcome& o) -> double& { return o.peak_acceleration; }},
    {"peak_force", "N", [](TrialOutcome& o) -> double& { return o.peak_force; }},
    {"peak_stroke", "m", [](TrialOutcome& o) -> double& { return o.peak_stroke; }},
    {"position_contraction_mean", "1", [](TrialOutcome& o) -> double& { return o.position_contraction.mean; }},
    {"position_contraction_worst", "1", [](TrialOutcome& o) -> double& { return o.position_contraction.worst; }},
    {"velocity_contraction_mean", "1", [](TrialOutcome& o) -> double& { return o.velocity_contraction.mean; }},
    {"velocity_contraction_worst", "1", [](TrialOutcome& o) -> double& { return o.velocity_contraction.worst; }},
};

inline constexpr OutcomeColumn<std::uint32_t> count_columns[] = {
    {"cycles", "1", [](TrialOutcome& o) -> std::uint32_t& { return o.cycles; }},
    {"swings", "1", [](TrialOutcome& o) -> std::uint32_t& { return o.swings; }},
    {"alignments", "1", [](TrialOutcome& o) -> std::uint32_t& { return o.alignments; }},
};

/// @param input  dotted name of an input that a plan varies
inline std::string units_of(const std::string& input) {
  return std::string(find_input(input)->unit);
}

}  // namespace steerstat::layout
