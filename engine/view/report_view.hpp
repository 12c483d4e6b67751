#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/summary.hpp"
#include "view/viewed_study.hpp"

namespace steerstat {

/// What of a study goes into a report.
struct ReportOptions {
  std::string file;                      ///< name of the result file, as the page tells it
  std::optional<std::string> created{};  ///< when the trials ran
  std::size_t failed{50};                ///< so many failed trials can be opened, the first ones shown
  std::size_t converged{10};             ///< and so many that converged
  std::size_t trial_points{600};         ///< of each trajectory, at most
  std::size_t bytes{4'400'000};          ///< the document is no longer, but where the study's own view already is
};

/// A report's document (schemas/view.schema.json, `report`), and what had to be left out of it.
struct Report {
  std::string document;               ///< JSON
  std::vector<std::uint64_t> trials;  ///< that can be opened
  std::size_t without_room{0};        ///< trials left out lest the document grow too long
  std::size_t without_replay{0};      ///< trials left out whose replay does not end in the stored bits
};

/// Makes a report: the study's view with maps of every pair of its ten most influential inputs, and replays.
///
/// @param summary  of the study's finished trials
Report report_of(const ViewedStudy& viewed, const Summary& summary, const ReportOptions& options);

}  // namespace steerstat
