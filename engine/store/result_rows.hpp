#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/status.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// Reads single trials of a complete result file, and of the file no more than their neighbourhood: a page of a study
/// of millions in milliseconds. Thread-safe.
///
/// It hands the file to HDF5 as it is, which does not survive all damage: is_sealed() must have found it whole.
class ResultRows {
 public:
  explicit ResultRows(std::filesystem::path path) : path_(std::move(path)) {}

  /// How each trial ended, by index. @throws RunFailure
  [[nodiscard]] std::vector<Status> statuses() const;

  /// @param index  of trials in the file, rising
  /// @return (index) their outcomes, the same bits as read_result()'s @throws RunFailure
  [[nodiscard]] std::vector<TrialOutcome> outcomes(std::span<const std::uint64_t> index) const;

 private:
  std::filesystem::path path_;
};

}  // namespace steerstat
