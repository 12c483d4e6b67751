#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "report/spec_difference_json.hpp"
#include "study/run.hpp"
#include "study/study.hpp"

namespace steerstat {

/// One side of a comparison: a study and its finished trials, as a result file holds them. Borrows them.
struct ComparedStudy {
  const Study& study;
  const StudyResult& result;
  const std::vector<std::vector<double>>& parameters;  ///< (varying x rows), in the order of Plan::varying()
  std::string engine_version;                          ///< of the program that ran it
};

/// Two studies whose trials are not trials of the same draws, so that nothing follows from pairing them.
class StudiesDoNotPair : public BadUsage {
 public:
  /// @param reasons  not empty, each `problem (rule); suggestion`
  explicit StudiesDoNotPair(std::vector<std::string> reasons);
  [[nodiscard]] const std::vector<std::string>& reasons() const { return reasons_; }

 private:
  std::vector<std::string> reasons_;
};

/// The trials that two studies have in common: the same draw in the same cell, so the same index in both.
struct Pairing {
  std::vector<std::pair<std::size_t, std::size_t>> rows;  ///< (pairs) of A and of B, by rising index
  std::vector<std::string> drawn;                         ///< inputs with the same drawn or listed values in each pair
};

/// Pairs the finished trials of two studies.
///
/// Paired are studies with the same seed, sampling method, drawn inputs and their distributions, listed trials, and
/// sweeps (two studies of a single cell pair whatever they sweep); everything else may differ. The stored values of the
/// drawn inputs are then compared, bit by bit. Of a study of Sobol' indices only A and B of each row are paired, which
/// are independent.
///
/// @param differences  spec_differences() of the two
/// @throws StudiesDoNotPair with every reason there is
Pairing pair_trials(const ComparedStudy& a, const ComparedStudy& b, const std::vector<SpecDifference>& differences);

}  // namespace steerstat
