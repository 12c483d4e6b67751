#include "report_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "core/errors.hpp"
#include "output.hpp"
#include "report/junit.hpp"
#include "report/markdown.hpp"
#include "store/result_file.hpp"

namespace steerstat {
namespace {

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  const std::filesystem::path first = std::filesystem::weakly_canonical(a, error);
  return !error && first == std::filesystem::weakly_canonical(b, error) && !error;
}

}  // namespace

void check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto& [option, path] = outputs[i];
    if (path == "-") throw BadUsage(fmt::format("{}: this does not go to standard output; name a file", option));
    for (const NamedFile& input : inputs) {
      if (input.path == "-" || !same_file(path, input.path)) continue;
      throw BadUsage(fmt::format("{} is {} itself and would be overwritten; name another output", path, input.option));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_file(outputs[j].path, path)) continue;
      throw BadUsage(fmt::format("{} and {} both name {}; give each its own file", outputs[j].option, option, path));
    }
  }
  for (const NamedFile& output : outputs) require_writable(output.path);
}

void ReportFiles::add_options(CLI::App& command) {
  command.add_option("--junit", junit, "Write the gates' verdicts to this file as JUnit XML")->type_name("FILE");
  command.add_option("--markdown", markdown, "Write the summary to this file as Markdown, fit for a job summary")
      ->type_name("FILE");
}

std::vector<NamedFile> ReportFiles::named() const {
  std::vector<NamedFile> files;
  if (junit) files.push_back({"--junit", *junit});
  if (markdown) files.push_back({"--markdown", *markdown});
  return files;
}

bool ReportFiles::write(const Summary& summary) const {
  bool all = true;
  const auto write_one = [&](const std::optional<std::string>& path, const char* what, auto text) {
    if (!path) return;
    const bool written = attempt([&] { write_text(*path, text(summary)); });
    if (written) tell(fmt::format("wrote {} to {}", what, *path));
    all = all && written;
  };
  write_one(junit, "the verdicts", junit_xml);
  write_one(markdown, "the summary", summary_markdown);
  return all;
}

}  // namespace steerstat
