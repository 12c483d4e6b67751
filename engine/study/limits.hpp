#pragma once

#include <cstddef>
#include <cstdint>

/// How large a study may be.
namespace steerstat {

/// A study's sweeps make at most this many cells.
inline constexpr std::uint64_t most_cells = 100'000;

/// At most this many draws a cell, and trials in all.
inline constexpr std::uint64_t most_trials = 1'000'000'000;

/// A study that does not keep all rows has at most this many cells: a sketch takes up to a megabyte a cell.
inline constexpr std::uint64_t most_sketched_cells = 1'000;

/// And audits at most this many trials, whose rows it keeps.
inline constexpr std::uint64_t most_sketched_audit = 10'000;

/// At most this many explicit trials.
inline constexpr std::size_t most_explicit_trials = 100'000;

/// At most this many correlations of two inputs.
inline constexpr std::size_t most_correlations = 1'000;

/// The method importance draws from at most this many components beside the nominal one.
inline constexpr std::size_t most_proposal_components = 32;

/// A subset simulation has at most this many levels, of at most this many states each.
inline constexpr std::uint64_t most_levels = 30;
inline constexpr std::uint64_t most_states = 10'000'000;

/// A discrete distribution has at most this many values.
inline constexpr std::size_t most_discrete_values = 10'000;

/// A study stops on at most this many goals of precision.
inline constexpr std::size_t most_precision_goals = 32;

/// At most this many trajectories are retained, of the failed trials and of the first ones each: a run holds them in
/// memory, up to half a megabyte a piece.
inline constexpr std::uint64_t most_trajectories = 1'000;

/// A study has at most this many gates; each may be judged in every cell.
inline constexpr std::size_t most_gates = 100;

/// A study's name has at most this many characters.
inline constexpr std::size_t longest_name = 100;

/// A bad spec's mistakes are reported up to this many.
inline constexpr std::size_t most_errors = 100;

}  // namespace steerstat
