#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "study/study.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// The trials of a study, by index.
///
/// Trial `index` is draw `index / cells()` in cell `index % cells()`: all cells share the draws (common random
/// numbers), and a study with more draws begins with the trials of one with fewer. Immutable, so safe to share
/// between threads.
class Plan {
 public:
  explicit Plan(const Study& study);

  [[nodiscard]] std::uint64_t trials() const;
  [[nodiscard]] std::uint64_t cells() const;
  [[nodiscard]] std::uint64_t cell_of(std::uint64_t index) const { return index % cells(); }

  /// Names of the inputs that vary between trials (distributions, sweeps, explicit columns), in spec order.
  [[nodiscard]] const std::vector<std::string>& varying() const;

  /// Writes the values of the varying inputs in trial `index`. @param values (varying) in the order of varying().
  void draw(std::uint64_t index, std::span<double> values) const;

  /// The parameters of a trial whose varying inputs have these values. @param values (varying).
  [[nodiscard]] TrialParameters parameters_with(std::span<const double> values) const;

  /// Both in one: the parameters of trial `index`.
  [[nodiscard]] TrialParameters parameters(std::uint64_t index) const;

  /// The swept inputs and their values in `cell`, in spec order; empty without sweeps.
  struct SweptValue {
    std::string name;
    double value;
  };
  [[nodiscard]] std::vector<SweptValue> sweep_values(std::uint64_t cell) const;
};

}  // namespace steerstat
