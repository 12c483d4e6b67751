#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "sampling/design.hpp"
#include "sampling/factorial.hpp"
#include "study/study.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// The trials of a study, by index.
///
/// Trial `index` is draw `index / cells()` in cell `index % cells()`: all cells share the draws (common random
/// numbers), and a study with more draws begins with the trials of one with fewer (but for a
/// Latin hypercube, whose strata depend on their number). Immutable, so safe to share between threads.
class Plan {
 public:
  /// @throws std::invalid_argument for a study that decode_study() would not return: an input that does not exist or
  ///         has two sources of values, a table of explicit trials with the wrong number of values, correlations of
  ///         inputs that are not drawn or that are not positive definite, a proposal of such inputs, or Sobol' indices
  ///         of no distribution, beside sweeps or with correlations
  explicit Plan(const Study& study);

  [[nodiscard]] std::uint64_t trials() const { return draws_ * cells(); }

  /// Draws that stand together: those of a row of a pick-freeze design (PickFreezeDesign), else 1.
  [[nodiscard]] std::uint64_t variants() const { return variants_; }

  /// Whether trial `index` is one of those that no other trial shares drawn values with, but for its cell: all, or the
  /// first two of each row of a pick-freeze design, A and B.
  [[nodiscard]] bool is_independent(std::uint64_t index) const { return index / cells() % variants_ < 2; }

  /// What trial `index` counts for (Design::weight): 1, but with the method importance.
  [[nodiscard]] double weight(std::uint64_t index) const { return design_->weight(index / cells()); }

  /// Whether trial `index` was drawn from the study's own distributions: all, but with the method importance.
  [[nodiscard]] bool is_nominal(std::uint64_t index) const { return design_->is_nominal(index / cells()); }

  [[nodiscard]] std::uint64_t cells() const { return cells_.cells(); }
  [[nodiscard]] std::uint64_t cell_of(std::uint64_t index) const { return index % cells(); }

  /// Names of the inputs that vary between trials (distributions, sweeps, explicit columns), in spec order.
  [[nodiscard]] const std::vector<std::string>& varying() const { return names_; }

  /// Writes the values of the varying inputs in trial `index`. @param values (varying) in the order of varying().
  void draw(std::uint64_t index, std::span<double> values) const;

  /// Writes the values that the varying inputs take at a point of the unit cube, without sweeps or listed trials.
  /// @param point (varying) @param values (varying)
  void place(std::span<const double> point, std::span<double> values) const;

  /// The parameters of trial `index` where its varying inputs have these values. @param values (varying).
  [[nodiscard]] TrialParameters parameters_with(std::uint64_t index, std::span<const double> values) const;

  /// Both in one: the parameters of trial `index`.
  [[nodiscard]] TrialParameters parameters(std::uint64_t index) const;

  /// The swept inputs and their values in `cell`, in spec order; empty without sweeps.
  struct SweptValue {
    std::string name;
    double value;
  };
  [[nodiscard]] std::vector<SweptValue> sweep_values(std::uint64_t cell) const;

 private:
  using Field = double& (*)(TrialParameters&);

  // Where a varying input's values come from.
  struct Drawn {
    Distribution distribution;
    std::size_t coordinate;  // in the design
    double scale;            // the nominal value where the distribution is relative, else 1
  };
  struct Swept {
    std::vector<double> values;
    std::size_t factor;  // in the factorial of cells
  };
  struct Listed {
    std::size_t column;  // of the explicit trials
  };
  using Source = std::variant<Drawn, Swept, Listed>;

  [[nodiscard]] double value_of(const Source& source, std::span<const double> point, std::uint64_t draw,
                                std::uint64_t cell) const;

  std::vector<std::string> names_;  // (varying)
  std::vector<Field> fields_;       // (varying)
  std::vector<Source> sources_;     // (varying)
  TrialParameters base_;            // with every value that does not vary
  std::uint64_t draws_;
  std::uint64_t variants_{1};
  Factorial cells_;
  std::shared_ptr<const Design> design_;
  std::size_t coordinates_;     // of the design
  std::uint64_t seed_;          // of the study
  std::vector<double> listed_;  // (draws x listed_columns_), explicit trials only
  std::size_t listed_columns_{0};
};

}  // namespace steerstat
