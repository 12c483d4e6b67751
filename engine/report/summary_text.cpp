#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "report/gates_text.hpp"
#include "report/metric_table.hpp"
#include "report/rare_failures_text.hpp"
#include "report/readable.hpp"
#include "report/summary.hpp"
#include "report/text_table.hpp"

namespace steerstat {
namespace {

using Align = TextTable::Align;

constexpr int bar_width = 40;
constexpr std::size_t most_cells = 30;  // more are shortened to the best and the worst
constexpr std::size_t best_cells = 15;
constexpr std::size_t worst_cells = 5;

fmt::text_style style_of(Status status) {
  if (status == Status::converged) return fg(fmt::terminal_color::green);
  return fg(status == Status::timeout ? fmt::terminal_color::yellow : fmt::terminal_color::red);
}

std::string heading(const Summary& summary, bool colour) {
  std::string text = styled(printable(summary.name), bold, colour) + '\n';
  std::string trials = counted(summary.requested, "trial");
  if (const std::size_t cells = summary.cells.size(); cells > 0) {
    trials += fmt::format(" ({} in each of {})", readable_count(summary.requested / cells), counted(cells, "cell"));
  }
  if (summary.stop) trials = "at most " + trials;
  text +=
      styled(fmt::format("{} · seed {} · id {} · engine {}", trials, summary.seed, summary.id, summary.engine_version),
             faint, colour) +
      '\n';
  if (!summary.complete) {
    const std::string what = summary.share ? "Shard " + share_text(*summary.share) : "Incomplete";
    text += styled(fmt::format("{}: {} of {} finished; what follows is of those.", what,
                               readable_count(summary.completed), counted(summary.requested, "trial")),
                   fg(fmt::terminal_color::yellow) | bold, colour) +
            '\n';
  }
  return text;
}

/// "the 95 % quantile of settling_time", "success_rate".
std::string name_of_goal(const PrecisionGoal& goal) {
  if (!goal.quantile) return goal.metric;
  return fmt::format("the {:.6g} % quantile of {}", 100.0 * *goal.quantile, goal.metric);
}

std::string stop_text(const Summary& summary, bool colour) {
  const auto& [rule, report] = *summary.stop;
  const bool reached = *report.reason == StopReason::precision_reached;
  std::string text =
      fmt::format("  {}  {} after {} of at most {}, at look {}\n", styled("Stopped", bold, colour),
                  reached ? "with the precision asked for" : "short of the precision asked for",
                  readable_count(report.trials), counted(summary.requested, "trial"), readable_count(report.looks));
  for (std::size_t i = 0; i < rule.until.size(); ++i) {
    const PrecisionGoal& goal = rule.until[i];
    const GoalProgress& progress = report.goals[i];
    const auto bound = [](std::optional<double> x) { return x ? fmt::format("{:.6g}", *x) : std::string(no_data); };
    text += fmt::format("           {} within {:.6g}{}: {} to {} at {:.6g} %{}\n", name_of_goal(goal),
                        goal.relative ? 100.0 * goal.half_width : goal.half_width, goal.relative ? " %" : "",
                        bound(progress.low), bound(progress.high), 100.0 * rule.level,
                        progress.reached ? "" : ", not reached");
  }
  return text;
}

std::string interval_text(const ProportionInterval& rate, std::uint64_t trials) {
  const std::string low = readable_share(rate.low, trials);
  return fmt::format("{} to {}", low.substr(0, low.size() - 2), readable_share(rate.high, trials));
}

/// What is to be said of an interval that does not count every trial for one.
const char* unit_note(IntervalUnit unit) {
  switch (unit) {
    case IntervalUnit::trial:
      return "";
    case IntervalUnit::draw:
      return ", of draws, which cells share";
    default:
      return ", as if trials were independent: one scrambling of Sobol's sequence tells none";
  }
}

const char* method_name(ProportionMethod method) {
  switch (method) {
    case ProportionMethod::wilson:
      return "Wilson";
    case ProportionMethod::clopper_pearson:
      return "Clopper-Pearson";
    default:
      return "confidence sequence";
  }
}

std::string success_text(const TrialStatistics& all, ProportionMethod method, bool colour) {
  if (!all.success_rate) return "  No trial has finished.\n";
  const ProportionInterval& rate = *all.success_rate;
  return fmt::format("  {}  {}   {} % interval {} ({}{})\n  {}\n", styled("Success rate", bold, colour),
                     styled(readable_share(rate.estimate, all.completed), bold, colour), 100.0 * rate.level,
                     interval_text(rate, all.completed), method_name(method), unit_note(all.unit),
                     styled(interval_bar(rate.low, rate.high, bar_width), style_of(Status::converged), colour));
}

std::string outcome_text(const TrialStatistics& all, bool colour) {
  TextTable table({{"Outcome", Align::left}, {"Trials"}, {"Share"}, {"", Align::left}});
  for (std::size_t i = 0; i < status_names.size(); ++i) {
    const std::uint64_t count = all.outcomes[i];
    const fmt::text_style style = count > 0 ? style_of(static_cast<Status>(i)) : faint;
    const double share = static_cast<double>(count) / static_cast<double>(all.completed);
    table.add_row({{std::string(status_names[i]), style},
                   {readable_count(count), style},
                   {count > 0 ? readable_share(share, all.completed) : no_data, style},
                   {count > 0 ? interval_bar(share, share, bar_width / 2) : "", style}});
  }
  return table.text(colour);
}

/// A study of one trial: a table of its quantiles would say one number eight times.
std::string single_text(const TrialStatistics& all, bool colour) {
  const auto found = std::find(all.outcomes.begin(), all.outcomes.end(), 1U);
  const auto status = static_cast<Status>(found - all.outcomes.begin());
  std::string text = "  " + styled(std::string(name_of(status)), bold | style_of(status), colour);
  const auto& settling_time = all.of("settling_time");
  const auto& cycles = all.of("cycles");
  if (settling_time && cycles) {
    text += fmt::format(" after {:.3f} s, {}", settling_time->mean,
                        counted(static_cast<std::uint64_t>(cycles->mean), "cycle"));
  }
  text += '\n';
  const auto& effort = all.of("effort");
  const auto& acceleration = all.of("peak_acceleration");
  const auto& force = all.of("peak_force");
  const auto& stroke = all.of("peak_stroke");
  if (effort && acceleration && force && stroke) {
    text += fmt::format("  effort {:.4g} N² s, at most {:.4g} m/s², {:.4g} N and {:.4g} m from the goal\n",
                        effort->mean, acceleration->mean, force->mean, stroke->mean);
  }
  return text;
}

/// The last `parts` dotted parts of a name.
std::string suffix(const std::string& name, std::size_t parts) {
  std::size_t begin = name.size() + 1;
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t dot = begin < 2 ? std::string::npos : name.rfind('.', begin - 2);
    if (dot == std::string::npos) return name;
    begin = dot + 1;
  }
  return name.substr(begin);
}

/// The swept inputs' names, without the leading parts that are not needed to tell them apart.
std::vector<std::string> short_names(const std::vector<Plan::SweptValue>& sweep) {
  constexpr std::size_t most_parts = 4;
  std::vector<std::string> names;
  for (std::size_t parts = 1; parts <= most_parts; ++parts) {
    names.clear();
    for (const Plan::SweptValue& swept : sweep) names.push_back(suffix(swept.name, parts));
    if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) break;
  }
  return names;
}

std::string failure_causes(const TrialStatistics& cell) {
  std::string text;
  for (std::size_t i = 0; i < status_names.size(); ++i) {
    if (static_cast<Status>(i) == Status::converged || cell.outcomes[i] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", readable_count(cell.outcomes[i]), status_names[i]);
  }
  return text;
}

std::vector<TextTable::Cell> cell_row(const Summary::Cell& cell) {
  const TrialStatistics& statistics = cell.statistics;
  std::vector<TextTable::Cell> row;
  for (const Plan::SweptValue& swept : cell.sweep) row.push_back({fmt::format("{:.6g}", swept.value)});
  const auto& rate = statistics.success_rate;
  row.push_back({rate ? readable_share(rate->estimate, statistics.completed) : no_data, bold});
  row.push_back({rate ? interval_text(*rate, statistics.completed) : no_data});
  const auto quantile = [](const std::optional<SampleStatistics>& sample, double SampleStatistics::*member,
                           int decimals) {
    return TextTable::Cell{sample ? fmt::format("{:.{}f}", (*sample).*member, decimals) : no_data};
  };
  row.push_back(quantile(statistics.of("settling_time"), &SampleStatistics::p50, 2));
  row.push_back(quantile(statistics.of("settling_time"), &SampleStatistics::p95, 2));
  row.push_back(quantile(statistics.of("cycles"), &SampleStatistics::p50, 1));
  row.push_back({failure_causes(statistics), faint});
  return row;
}

/// The cells' numbers by falling success rate, then rising median settling time, then number.
std::vector<std::size_t> ranking(const std::vector<Summary::Cell>& cells) {
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const TrialStatistics& statistics = cells[i].statistics;
    const auto& settling_time = statistics.of("settling_time");
    return std::pair(statistics.success_rate ? -statistics.success_rate->estimate : 1.0,
                     settling_time ? settling_time->p50 : 0.0);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

std::string cells_text(const std::vector<Summary::Cell>& cells, double level, bool colour) {
  std::vector<TextTable::Column> columns;
  for (std::string& name : short_names(cells.front().sweep)) columns.push_back({std::move(name)});
  columns.insert(columns.end(), {{"Success"},
                                 {fmt::format("{} % interval", 100.0 * level)},
                                 {"Median [s]"},
                                 {"95 % [s]"},
                                 {"Cycles"},
                                 {"Failures", Align::left}});
  TextTable table(columns);
  if (cells.size() <= most_cells) {
    for (const Summary::Cell& cell : cells) table.add_row(cell_row(cell));
    return table.text(colour);
  }
  const std::vector<std::size_t> order = ranking(cells);
  for (std::size_t i = 0; i < best_cells; ++i) table.add_row(cell_row(cells[order[i]]));
  table.add_row(std::vector<TextTable::Cell>(columns.size(), {"⋮", faint}));
  for (std::size_t i = order.size() - worst_cells; i < order.size(); ++i) table.add_row(cell_row(cells[order[i]]));
  return table.text(colour) +
         styled(fmt::format("  The {} best and {} worst of {} cells by success rate; the JSON summary has them all.\n",
                            best_cells, worst_cells, readable_count(cells.size())),
                faint, colour);
}

/// Some indices in words: "3, 14 and 2 more".
std::string indices_text(const std::vector<std::uint64_t>& indices) {
  constexpr std::size_t most_indices = 5;
  const std::size_t shown = std::min(indices.size(), most_indices);
  std::string text = fmt::format("{}", fmt::join(indices.begin(), indices.begin() + static_cast<long>(shown), ", "));
  if (shown < indices.size()) text += fmt::format(" and {} more", readable_count(indices.size() - shown));
  return text;
}

std::string audit_text(const AuditStatistics& audit, bool colour) {
  const bool all = audit.agree == audit.trials;
  std::string text = fmt::format("  {}  {} with SUNDIALS at tolerance {:.3g} in status, cycles and swings\n",
                                 styled("Audit", bold, colour),
                                 styled(fmt::format("{} of {} agree{}", readable_count(audit.agree),
                                                    counted(audit.trials, "trial"), audit.trials == 1 ? "s" : ""),
                                        fg(all ? fmt::terminal_color::green : fmt::terminal_color::red), colour),
                                 audit.tolerance);
  if (!all) text += fmt::format("         Not trial {}.\n", indices_text(audit.disagree));
  if (const auto& difference = audit.settling_time_difference) {
    text += fmt::format("         Settling times differ by {:.1e} s in the median, {:.1e} s at most.\n",
                        difference->median, difference->max);
  }
  return text;
}

std::string performance_text(const Summary& summary, bool colour) {
  if (summary.completed == 0 || !(summary.wall_s > 0.0)) return {};
  const double rate = static_cast<double>(summary.completed) / summary.wall_s;
  return styled(fmt::format("{} in {} on {}{}: {} trials/s", counted(summary.completed, "trial"),
                            readable_duration(summary.wall_s), counted(summary.threads, "thread"),
                            summary.simd ? fmt::format(" with {}", name_of(*summary.simd)) : "", readable_rate(rate)),
                faint, colour) +
         '\n';
}

}  // namespace

std::string summary_text(const Summary& summary, bool colour) {
  std::string text = heading(summary, colour) + '\n';
  if (summary.all.completed == 1 && summary.cells.empty()) {
    text += single_text(summary.all, colour);
  } else if (summary.rare_failures) {
    text += rare_failures_text(*summary.rare_failures, colour);
  } else {
    text += success_text(summary.all, summary.intervals.method, colour);
    if (summary.sensitivity) {
      text += styled(fmt::format("  Of the {} that are independent, A and B of each row.\n",
                                 counted(summary.all.completed, "trial")),
                     faint, colour);
    }
    if (summary.all.completed > 0) text += '\n' + outcome_text(summary.all, colour);
    if (const std::string tables = metric_tables(summary.all, colour); !tables.empty()) text += '\n' + tables;
    if (summary.store != Store::all && summary.all.completed > 0) {
      text += styled(fmt::format("  Quantiles are a sketch's, within {:.1f} %; the rows of {} are kept.\n",
                                 100.0 * QuantileSketch::relative_error,
                                 summary.store == Store::failed ? "failed trials" : "no trials"),
                     faint, colour);
    }
    if (!summary.cells.empty()) text += '\n' + cells_text(summary.cells, summary.intervals.level, colour);
  }
  if (summary.stop && summary.stop->report.reason) text += '\n' + stop_text(summary, colour);
  if (summary.sensitivity && summary.completed > 0) text += '\n' + sobol_text(*summary.sensitivity, colour);
  if (!summary.gates.empty()) text += '\n' + gates_text(summary.gates, colour);
  if (summary.audit) text += '\n' + audit_text(*summary.audit, colour);
  return text + '\n' + performance_text(summary, colour);
}

}  // namespace steerstat
