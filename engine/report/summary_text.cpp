#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>

#include "report/cells_text.hpp"
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
                     readable_shares(rate.low, rate.high, all.completed), method_name(method), unit_note(all.unit),
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
