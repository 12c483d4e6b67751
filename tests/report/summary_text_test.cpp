#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "report/text_table.hpp"
#include "sample_summary.hpp"

namespace steerstat {
namespace {

using namespace testing_report;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(SummaryText, TellsWhatAPersonAsksFirst) {
  const std::string text = summary_text(made_up_summary({1403, 590, 5, 2, 0}), false);
  EXPECT_THAT(text, HasSubstr("sample\n2,000 trials · seed 7 · id 0123456789abcdef · engine 0.1.0\n"));
  EXPECT_THAT(text, HasSubstr("Success rate  70.15 %   95 % interval 68.11 to 72.12 % (Wilson)"));
  EXPECT_THAT(text, HasSubstr("  timeout               590  29.50 %  ██████"));
  EXPECT_THAT(text, HasSubstr("  integrator_failed       0        –\n"));
  EXPECT_THAT(text, HasSubstr("settling time [s]  10.00  711.00  7020.00"));
  EXPECT_THAT(text, HasSubstr("effort [N² s]         0.5  50.48   500.2   950   990  1000  500.2  288.7\n"));
  EXPECT_THAT(text, HasSubstr("peak |q1 - goal| [m]  0.5"));
  EXPECT_THAT(text, HasSubstr("\n  position, mean      0.0010  0.0711  0.7020"));
  EXPECT_THAT(text, Not(HasSubstr("position, worst"))) << "no trial has it";
  EXPECT_THAT(text, HasSubstr("2,000 trials in 4.0 s on 2 threads with avx512: 500 trials/s"));
  EXPECT_THAT(text, Not(HasSubstr("Incomplete")));
}

TEST(SummaryText, FitsATerminalAndLeavesNoSpacesAtLineEnds) {
  for (const Summary& summary : {made_up_summary({1403, 590, 5, 2, 0}), made_up_sweep(5), made_up_sweep(300)}) {
    for (const std::string& line : lines_of(summary_text(summary, false))) {
      EXPECT_LE(display_width(line), 100U) << line;
      EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
    }
  }
}

TEST(SummaryText, IsTheSameWithColoursButForThem) {
  const Summary summary = made_up_sweep(40);
  std::string coloured = summary_text(summary, true);
  EXPECT_NE(coloured, summary_text(summary, false));
  while (coloured.find('\x1b') != std::string::npos) {
    const std::size_t begin = coloured.find('\x1b');
    coloured.erase(begin, coloured.find('m', begin) + 1 - begin);
  }
  EXPECT_EQ(coloured, summary_text(summary, false));
}

TEST(SummaryText, SaysThatARunIsIncomplete) {
  Summary summary = made_up_summary({3, 1, 0, 0, 0});
  summary.complete = false;
  summary.requested = 5000;
  EXPECT_THAT(summary_text(summary, false), HasSubstr("Incomplete: 4 of 5,000 trials finished"));
}

TEST(SummaryText, SaysThatNoTrialHasFinished) {
  Summary summary = made_up_summary({});
  summary.complete = false;
  summary.requested = 10;
  EXPECT_THAT(summary_text(summary, false), AllOf(HasSubstr("No trial has finished."), Not(HasSubstr("nan"))));
}

TEST(SummaryText, SaysWhereTheStudyStoppedAndWhy) {
  Summary summary = made_up_summary({90, 10, 0, 0, 0});
  summary.requested = 5000;
  summary.intervals.method = ProportionMethod::confidence_sequence;
  Summary::Stop& stop = summary.stop.emplace();
  stop.rule = {50, 10, 0.95, {{"success_rate", std::nullopt, 0.1, false}, {"settling_time", 0.95, 0.2, true}}};
  stop.report = {100, 6, StopReason::precision_reached, {{0, 0.9, 0.8, 0.95, true}, {0, 400.0, 362.5, 410.0, true}}};
  const std::string text = summary_text(summary, false);
  EXPECT_THAT(text, HasSubstr("at most 5,000 trials"));
  EXPECT_THAT(text, HasSubstr("(confidence sequence)"));
  EXPECT_THAT(text, HasSubstr("\n  Stopped  with the precision asked for after 100 of at most 5,000 trials, at look 6\n"
                              "           success_rate within 0.1: 0.8 to 0.95 at 95 %\n"
                              "           the 95 % quantile of settling_time within 20 %: 362.5 to 410 at 95 %\n"));
  stop.report.reason = StopReason::max_trials;
  stop.report.goals[1] = {0, 400.0, 362.5, std::nullopt, false};
  EXPECT_THAT(summary_text(summary, false),
              AllOf(HasSubstr("short of the precision asked for"), HasSubstr("362.5 to – at 95 %, not reached\n")));
  stop.report.reason.reset();
  EXPECT_THAT(summary_text(summary, false), Not(HasSubstr("Stopped")));
}

Summary audited_summary(AuditStatistics audit) {
  Summary summary = made_up_summary({1403, 590, 5, 2, 0});
  summary.audit = std::move(audit);
  return summary;
}

TEST(SummaryText, SaysThatTheAuditAgrees) {
  const std::string text = summary_text(
      audited_summary({16, 16, {}, AuditStatistics::Difference{1.24e-8, 2e-8, 3.1e-8}, 1e-9 / 100.0}), false);
  EXPECT_THAT(text,
              HasSubstr("\n  Audit  16 of 16 trials agree with SUNDIALS at tolerance 1e-11 in status, cycles and "
                        "swings\n         Settling times differ by 1.2e-08 s in the median, 3.1e-08 s at most.\n"));
  EXPECT_THAT(text, Not(HasSubstr("Not trial")));
}

TEST(SummaryText, NamesTheFirstTrialsThatTheAuditContradicts) {
  EXPECT_THAT(summary_text(audited_summary({16, 14, {3, 99}, {}, 1e-11}), false),
              AllOf(HasSubstr("14 of 16 trials agree"), HasSubstr("Not trial 3, 99.\n"), Not(HasSubstr("differ"))));
  const std::string many = summary_text(audited_summary({2000, 1993, {1, 2, 3, 4, 5, 6, 7}, {}, 1e-11}), false);
  EXPECT_THAT(many, HasSubstr("Not trial 1, 2, 3, 4, 5 and 2 more.\n"));
  for (const std::string& line : lines_of(many)) EXPECT_LE(display_width(line), 100U) << line;
}

TEST(SummaryText, DoesNotMentionAnAuditThatWasNotMade) {
  EXPECT_THAT(summary_text(made_up_summary({5, 5, 0, 0, 0}), false), Not(HasSubstr("Audit")));
}

TEST(SummaryText, OfOneTrialIsOneSentence) {
  EXPECT_THAT(summary_text(made_up_summary({1, 0, 0, 0, 0}), false),
              AllOf(HasSubstr("converged after 10.000 s, 1 cycle\n"), Not(HasSubstr("interval"))));
  EXPECT_THAT(summary_text(made_up_summary({0, 0, 1, 0, 0}), false), HasSubstr("  singular\n"));
  EXPECT_THAT(summary_text(made_up_summary({1, 0, 0, 0, 0}), false),
              HasSubstr("  effort 0.5 N² s, at most 0.5 m/s², 0.5 N and 0.5 m from the goal\n"));
}

TEST(SummaryText, HasNoSettlingTimesWhereNoTrialConverged) {
  const std::string text = summary_text(made_up_summary({0, 50, 0, 0, 0}), false);
  EXPECT_THAT(text, AllOf(HasSubstr("Success rate  0.0 %   95 % interval 0.0 to 7.1 %"),
                          HasSubstr("  timeout                50  100.0 %"), Not(HasSubstr("settling"))));
}

TEST(SummaryText, ListsAllOfAFewCellsInTheirOrder) {
  const std::string text = summary_text(made_up_sweep(30), false);
  EXPECT_THAT(text, HasSubstr("300 trials (10 in each of 30 cells)"));
  EXPECT_THAT(text, HasSubstr("\n   eta1  Success"));
  const std::vector<std::string> lines = lines_of(text);
  auto line = std::find_if(lines.begin(), lines.end(), [](const std::string& l) { return l.find("eta1") != l.npos; });
  ASSERT_GT(lines.end() - line, 31);
  line += 2;  // past the header and its rule
  for (int cell = 0; cell < 30; ++cell, ++line) {
    double value = -1.0;
    double success = -1.0;
    std::istringstream(*line) >> value >> success;
    EXPECT_DOUBLE_EQ(value, 0.001 * cell) << *line;
    EXPECT_EQ(success, 10.0 * (cell % 11)) << *line;
  }
  EXPECT_THAT(text, Not(HasSubstr("⋮")));
  EXPECT_THAT(text, HasSubstr("10 timeout"));
}

TEST(SummaryText, ShortensManyCellsToTheBestAndTheWorstAndSaysWhereTheRestIs) {
  const std::string text = summary_text(made_up_sweep(31), false);
  EXPECT_THAT(text, HasSubstr("The 15 best and 5 worst of 31 cells by success rate; the JSON summary has them all."));
  const std::vector<std::string> lines = lines_of(text);
  const auto gap =
      std::find_if(lines.begin(), lines.end(), [](const std::string& line) { return line.find("⋮") != line.npos; });
  ASSERT_NE(gap, lines.end());
  EXPECT_THAT(*(gap - 15), AllOf(HasSubstr("0.01 "), HasSubstr("100.0 %")));  // cell 10, all of ten
  EXPECT_THAT(*(gap + 5), AllOf(HasSubstr("0.022 "), HasSubstr("0.0 %")));    // cell 22, none, last by number
}

TEST(SummaryText, NamesSweptInputsByWhatTellsThemApart) {
  Summary summary = made_up_sweep(2);
  for (Summary::Cell& cell : summary.cells) {
    cell.sweep = {{"controller.alignment.tolerance", 1e-3}, {"controller.convergence.tolerance", 5e-3}};
  }
  EXPECT_THAT(summary_text(summary, false), HasSubstr("  alignment.tolerance  convergence.tolerance  Success"));
  for (Summary::Cell& cell : summary.cells) cell.sweep = {{"plant.m1", 1.0}, {"controller.contraction.eta1", 0.5}};
  EXPECT_THAT(summary_text(summary, false), HasSubstr("  m1  eta1  Success"));
}

TEST(SummaryText, DoesNotLetANameSteerTheTerminal) {
  Summary summary = made_up_summary({1, 1, 0, 0, 0});
  summary.name = "\x1b[2Jgone";
  EXPECT_EQ(summary_text(summary, false).find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace steerstat
