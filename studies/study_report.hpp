#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "exit_code.hpp"
#include "report/baseline.hpp"
#include "report/summary.hpp"
#include "report_files.hpp"

namespace steerstat {

/// What `run` and `merge` do with a study's summary: print it, write it, and judge it.
struct StudyReport {
  std::optional<std::string> summary;  ///< "-": standard output, in the table's place
  ReportFiles files;
  std::optional<std::string> baseline;  ///< "-": standard input

  /// Adds --summary, --junit, --markdown and --baseline to a command; this object must outlive it.
  void add_options(CLI::App& command);

  /// The files that were asked for.
  [[nodiscard]] std::vector<NamedFile> outputs() const;

  /// @throws BadUsage where there is a baseline that cannot be read, or that is of another population
  [[nodiscard]] std::optional<Baseline> read_baseline(const Study& study) const;

  /// Prints and writes what was asked for and says so. One full disk does not take the rest along.
  /// @param trials_at  where the trials were written; "": nowhere
  /// @return whether all of it was written
  [[nodiscard]] bool write(const Summary& summary, const std::string& trials_at) const;

 private:
  [[nodiscard]] bool prints_json() const { return summary == "-"; }
};

/// What a study's gates come to.
ExitCode exit_code_of(const Summary& summary);

}  // namespace steerstat
