#include "report/markdown.hpp"

#include <fmt/format.h>

#include "report/rare_failures_text.hpp"
#include "report/readable.hpp"
#include "report/verdict.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

constexpr std::size_t most_table_rows = 50;  // GitHub cuts a job summary at 1 MiB

/// Text that shows as it is. Character references are never taken for markup, in tables either.
std::string literal(const std::string& text) {
  std::string result;
  for (const char c : printable(text)) {
    const bool is_markup = std::string_view("&<>\\`*_[]|~#@$!:").find(c) != std::string_view::npos;
    result += is_markup ? fmt::format("&#{};", static_cast<int>(c)) : std::string(1, c);
  }
  return result;
}

/// Text of the program's own that shows as code. It has no backquote and no vertical bar.
std::string code(std::string_view text) {
  return fmt::format("`{}`", text);
}

std::string_view icon(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "✅ pass";
    case Verdict::fail:
      return "❌ fail";
    default:
      return "⚠️ inconclusive";
  }
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : no_data;
}

std::string gate_interval(const SampleInterval& interval) {
  if (!interval.low && !interval.high) return no_data;
  return fmt::format("{} to {}", number(interval.low), number(interval.high));
}

std::string gates_table(const Summary& summary) {
  if (summary.gates.empty()) return {};
  std::string text = fmt::format("| Verdict | Gate | Value | {:.6g} % interval | Why |\n|---|---|--:|--:|---|\n",
                                 100.0 * summary.intervals.level);
  for (const GateVerdict& gate : summary.gates) {
    text += fmt::format("| {} | {} | {} | {} | {} |\n", icon(gate.verdict), code(gate_title(gate)), number(gate.value),
                        gate_interval(gate.interval), literal(gate.reason));
  }
  return text + '\n';
}

std::string rate_text(const TrialStatistics& statistics) {
  if (!statistics.success_rate) return no_data;
  const ProportionInterval& rate = *statistics.success_rate;
  return fmt::format("**{}**, {} % interval {} to {}", readable_share(rate.estimate, statistics.completed),
                     100.0 * rate.level, readable_share(rate.low, statistics.completed),
                     readable_share(rate.high, statistics.completed));
}

std::string outcomes_table(const TrialStatistics& statistics) {
  if (statistics.completed == 0) return {};
  std::string text = "| Outcome | Trials | Share |\n|---|--:|--:|\n";
  for (std::size_t i = 0; i < status_names.size(); ++i) {
    const std::uint64_t count = statistics.outcomes[i];
    const double share = static_cast<double>(count) / static_cast<double>(statistics.completed);
    text += fmt::format("| {} | {} | {} |\n", code(status_names[i]), readable_count(count),
                        count > 0 ? readable_share(share, statistics.completed) : no_data);
  }
  return text + '\n';
}

std::string metrics_table(const TrialStatistics& statistics) {
  std::string rows;
  for (std::size_t i = 0; i < metric_count; ++i) {
    if (!statistics.metrics[i]) continue;
    const SampleStatistics& s = *statistics.metrics[i];
    const Metric& metric = metrics()[i];
    rows += fmt::format("| {} | {} | {} | {:.5g} | {:.5g} | {:.5g} | {:.5g} | {:.5g} | {:.5g} |\n", code(metric.name),
                        metric.unit == "1" ? "" : code(metric.unit), readable_count(s.count), s.mean, s.p05, s.p50,
                        s.p95, s.p99, s.max);
  }
  if (rows.empty()) return {};
  return "| Metric | Unit | Trials | Mean | 5 % | Median | 95 % | 99 % | Max "
         "|\n|---|---|--:|--:|--:|--:|--:|--:|--:|\n" +
         rows + '\n';
}

std::string cells_table(const Summary& summary) {
  if (summary.cells.empty()) return {};
  std::string text = "| Cell | Trials | Success rate |\n|---|--:|---|\n";
  for (std::size_t i = 0; i < summary.cells.size() && i < most_table_rows; ++i) {
    const Summary::Cell& cell = summary.cells[i];
    std::string name;
    for (const Plan::SweptValue& swept : cell.sweep) {
      name += fmt::format("{}{} = {}", name.empty() ? "" : ", ", swept.name, swept.value);
    }
    text += fmt::format("| {} | {} | {} |\n", code(name), readable_count(cell.statistics.completed),
                        rate_text(cell.statistics));
  }
  if (summary.cells.size() > most_table_rows) {
    text += fmt::format("\nThe first {} of {} cells.\n", most_table_rows, readable_count(summary.cells.size()));
  }
  return text + '\n';
}

}  // namespace

std::string summary_markdown(const Summary& summary) {
  std::string text = fmt::format("## {}", literal(summary.name));
  if (!summary.gates.empty()) text += fmt::format(": {}", icon(worst_verdict(summary.gates)));
  text += "\n\n";
  if (!summary.complete) {
    text += fmt::format("**Incomplete**: {} of {} trials finished; what follows is of those.\n\n",
                        readable_count(summary.completed), readable_count(summary.requested));
  }
  text += gates_table(summary);
  if (summary.rare_failures) {
    text += fmt::format("Failure rate {}, {}\n\n", failure_rate_text(*summary.rare_failures),
                        counted(summary.all.completed, "trial"));
  } else {
    text += fmt::format("Success rate {}, {}\n\n", rate_text(summary.all), counted(summary.all.completed, "trial"));
    text += outcomes_table(summary.all);
  }
  text += metrics_table(summary.all) + cells_table(summary);
  text += fmt::format("Seed {}, id {}, engine {}", summary.seed, code(summary.id), summary.engine_version);
  if (summary.wall_s > 0.0) {
    text += fmt::format(", {} on {}", readable_duration(summary.wall_s), counted(summary.threads, "thread"));
  }
  return text + "\n";
}

}  // namespace steerstat
