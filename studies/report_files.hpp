#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "report/summary.hpp"

namespace steerstat {

/// A file that an option names.
struct NamedFile {
  std::string option;  ///< "--junit"
  std::string path;
};

/// Refuses outputs that would overwrite an input or each other, those called "-", and those that cannot be written:
/// before anything is run.
///
/// @param inputs  files that are read, whose options are what a message calls them: "the spec"
/// @throws BadUsage, and RunFailure for what cannot be written
void check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// Files for continuous integration, made from a summary.
struct ReportFiles {
  std::optional<std::string> junit;
  std::optional<std::string> markdown;

  /// Adds --junit and --markdown to a command; this object must outlive it.
  void add_options(CLI::App& command);

  /// Those that were asked for.
  [[nodiscard]] std::vector<NamedFile> named() const;

  /// Writes what was asked for and says so. A failure is told too, and does not keep the other from being written.
  /// @return whether all of it was written
  [[nodiscard]] bool write(const Summary& summary) const;
};

}  // namespace steerstat
