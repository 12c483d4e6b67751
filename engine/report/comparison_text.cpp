#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>

#include "report/comparison.hpp"
#include "report/readable.hpp"
#include "report/text_table.hpp"

namespace steerstat {
namespace {

using Align = TextTable::Align;

constexpr std::size_t most_cells_listed = 30;
constexpr std::size_t longest_value = 60;

std::string side_text(const char* letter, const Comparison::Side& side, bool colour) {
  return fmt::format(
      "  {}  {} {}\n", letter, styled(printable(side.name), bold, colour),
      styled(fmt::format("· {} · id {} · engine {}", counted(side.completed, "trial"), side.id, side.engine_version),
             faint, colour));
}

std::string value_text(const std::optional<std::string>& value) {
  if (!value) return no_data;
  const std::string text = printable(*value);
  return text.size() <= longest_value ? text : text.substr(0, longest_value) + "...";
}

std::string differences_text(const std::vector<SpecDifference>& differences, bool colour) {
  if (differences.empty()) return {};
  TextTable table({{"What differs", Align::left}, {"A", Align::left}, {"B", Align::left}});
  for (const SpecDifference& difference : differences) {
    table.add_row({{printable(difference.pointer)}, {value_text(difference.a)}, {value_text(difference.b)}});
  }
  return table.text(colour) + '\n';
}

std::string counts_text(const PairedCounts& counts, bool colour) {
  TextTable table({{counted(counts.pairs(), "pair"), Align::left}, {"B converged"}, {"B did not"}});
  table.add_row({{"A converged"}, {readable_count(counts.both)}, {readable_count(counts.a_only), bold}});
  table.add_row({{"A did not"}, {readable_count(counts.b_only), bold}, {readable_count(counts.neither)}});
  return table.text(colour);
}

/// A difference of shares in percentage points, to the digits that a change of one pair has.
std::string points(double difference, std::uint64_t pairs) {
  int decimals = 1;
  for (std::uint64_t finest = 1000; finest <= pairs && decimals < 4; finest *= 10) ++decimals;
  return fmt::format("{:+.{}f}", 100.0 * difference, decimals);
}

std::string probability(double p) {
  return p < 1e-4 ? fmt::format("{:.1e}", p) : fmt::format("{:.4f}", p);
}

std::string success_text(const PairedStatistics& all, bool colour) {
  const PairedCounts& counts = all.counts;
  const std::uint64_t n = counts.pairs();
  const auto rate = [&](std::uint64_t only) {
    return readable_share(static_cast<double>(counts.both + only) / static_cast<double>(n), n);
  };
  std::string text =
      fmt::format("  Success rate of A {}, of B {}\n", rate(counts.a_only), rate(counts.b_only)) +
      fmt::format("  B less A {} percentage points", styled(points(difference_of(counts), n), bold, colour));
  if (const auto& interval = all.success_rate_difference) {
    text += fmt::format("   {} % interval {} to {} (Tango)\n", 100.0 * interval->level, points(interval->low, n),
                        points(interval->high, n));
  } else {
    text += "; the cells share their draws, so that intervals and tests are for each alone\n";
  }
  if (all.test) {
    text += fmt::format("  McNemar's exact test p = {} (mid-p {})\n", probability(all.test->p_value),
                        probability(all.test->mid_p_value));
  }
  return text;
}

std::string interval_note(const SampleInterval& interval) {
  if (!interval.low || !interval.high) return {};
  return fmt::format(" ({} % interval {:+.2f} to {:+.2f})", 100.0 * comparison_level, *interval.low, *interval.high);
}

std::string settling_text(const PairedStatistics& all) {
  const auto& difference = all.settling_time_difference;
  if (!difference) return "  In no pair both converged: settling times cannot be compared.\n";
  const SampleStatistics& sample = difference->sample;
  return fmt::format(
      "  Settling time where both converged, B less A [s]:\n"
      "    mean {:+.2f}{}, median {:+.2f}{}; 5 % {:+.2f}, 95 % {:+.2f}\n",
      sample.mean, interval_note(difference->mean), sample.p50, interval_note(difference->median), sample.p05,
      sample.p95);
}

std::vector<TextTable::Cell> cell_row(const Comparison::Cell& cell) {
  const PairedStatistics& statistics = cell.statistics;
  const PairedCounts& counts = statistics.counts;
  std::vector<TextTable::Cell> row;
  for (const Plan::SweptValue& swept : cell.sweep) row.push_back({fmt::format("{:.6g}", swept.value)});
  for (const std::uint64_t count : {counts.pairs(), counts.a_only, counts.b_only}) {
    row.push_back({readable_count(count)});
  }
  const auto& interval = statistics.success_rate_difference;
  row.push_back({interval ? points(interval->estimate, counts.pairs()) : no_data, bold});
  row.push_back(
      {interval ? fmt::format("{} to {}", points(interval->low, counts.pairs()), points(interval->high, counts.pairs()))
                : no_data});
  row.push_back({statistics.test ? probability(statistics.test->p_value) : no_data});
  row.push_back({statistics.holm_p_value ? probability(*statistics.holm_p_value) : no_data});
  const auto& settling = statistics.settling_time_difference;
  row.push_back({settling ? fmt::format("{:+.2f}", settling->sample.p50) : no_data});
  return row;
}

std::string cells_text(const std::vector<Comparison::Cell>& cells, bool colour) {
  if (cells.empty()) return {};
  std::vector<TextTable::Column> columns;
  for (const Plan::SweptValue& swept : cells.front().sweep) columns.push_back({swept.name});
  columns.insert(columns.end(), {{"Pairs"},
                                 {"A alone"},
                                 {"B alone"},
                                 {"B - A [points]"},
                                 {fmt::format("{} % interval", 100.0 * comparison_level)},
                                 {"p"},
                                 {"p (Holm)"},
                                 {"Median B - A [s]"}});
  TextTable table(columns);
  const std::size_t listed = std::min(cells.size(), most_cells_listed);
  for (std::size_t i = 0; i < listed; ++i) table.add_row(cell_row(cells[i]));
  std::string text = '\n' + table.text(colour);
  if (listed < cells.size()) {
    text +=
        styled(fmt::format("  The first {} of {} cells; --json has them all.\n", listed, readable_count(cells.size())),
               faint, colour);
  }
  return text;
}

/// A file's name as a shell takes it.
std::string shell_word(const std::string& name) {
  std::string word = "'";
  for (const char c : printable(name)) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
           c == '-' || c == '/';
  });
  return plain ? name : word + "'";
}

std::string discordant_text(const char* who, const DiscordantTrials& trials, const std::string& file_a,
                            const std::string& file_b, std::uint64_t most_listed) {
  if (trials.count == 0) return fmt::format("  {} alone converged in no pair\n", who);
  std::string text = fmt::format("  {} alone converged in {}\n", who, counted(trials.count, "pair"));
  const std::size_t listed = std::min<std::size_t>(trials.indices.size(), most_listed);
  for (std::size_t i = 0; i < listed; ++i) {
    text += fmt::format("    steerstat replay {} --trial {}   # and of {}\n", shell_word(file_a), trials.indices[i],
                        shell_word(file_b));
  }
  if (listed < trials.count) {
    text += fmt::format("    {} more: --list N lists N, --json all\n", readable_count(trials.count - listed));
  }
  return text;
}

}  // namespace

std::string comparison_text(const Comparison& comparison, const std::string& file_a, const std::string& file_b,
                            std::uint64_t most_listed, bool colour) {
  std::string text = styled("Two studies on the same draws", bold, colour) + '\n' +
                     side_text("A", comparison.a, colour) + side_text("B", comparison.b, colour);
  for (const std::string& warning : comparison.warnings) {
    text += styled(fmt::format("  Note: {}.\n", warning), fg(fmt::terminal_color::yellow), colour);
  }
  text += '\n' + differences_text(comparison.differences, colour);
  text += counts_text(comparison.all.counts, colour) + '\n';
  text += success_text(comparison.all, colour);
  text += settling_text(comparison.all);
  text += cells_text(comparison.cells, colour) + '\n';
  text += discordant_text("A", comparison.a_only, file_a, file_b, most_listed);
  text += discordant_text("B", comparison.b_only, file_a, file_b, most_listed);
  return text;
}

}  // namespace steerstat
