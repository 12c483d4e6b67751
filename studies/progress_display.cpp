#include "progress_display.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "output.hpp"
#include "report/readable.hpp"

namespace steerstat {
namespace {

constexpr double seconds_between_lines = 5.0;

double done(const Progress& progress) {
  if (progress.requested == 0) return 1.0;
  return static_cast<double>(progress.completed) / static_cast<double>(progress.requested);
}

/// Rounded down: 100 % means done.
unsigned percent(const Progress& progress) {
  return static_cast<unsigned>(100.0 * done(progress));
}

/// "900 / 2,000 trials", then the rate and the time left once they say something.
std::vector<std::string> facts(const Progress& progress) {
  std::vector<std::string> facts{
      fmt::format("{} / {} trials", readable_count(progress.completed), readable_count(progress.requested))};
  if (progress.completed <= progress.earlier || progress.elapsed < 0.1) return facts;
  const double rate = static_cast<double>(progress.completed - progress.earlier) / progress.elapsed;
  // Whole seconds: tenths that change with every redraw are noise.
  const double left = std::ceil(static_cast<double>(progress.requested - progress.completed) / rate);
  facts.push_back(readable_rate(rate) + "/s");
  facts.push_back((left < 120.0 ? fmt::format("{:.0f} s", left) : readable_duration(left)) + " left");
  return facts;
}

std::string bar(double fraction, std::size_t cells) {
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(cells));
  std::string text;
  for (std::size_t i = 0; i < cells; ++i) text += i < filled ? "━" : "─";
  return text;
}

}  // namespace

std::string bar_line(const Progress& progress, unsigned columns, bool stopping) {
  constexpr std::size_t shortest_bar = 10;
  constexpr std::size_t longest_bar = 40;
  // The last column stays free: some terminals wrap as soon as it is filled.
  const std::size_t room = columns > 0 ? columns - 1 : 0;
  const std::string head = fmt::format("{:3} %", percent(progress));
  std::vector<std::string> parts = facts(progress);
  if (stopping) {
    parts.resize(1);
    parts.emplace_back("stopping after the trials in flight");
  }
  std::string tail;
  for (const std::string& part : parts) {  // what does not fit goes, last first
    if (head.size() + tail.size() + 2 + part.size() > room) break;
    tail += "  " + part;
  }
  const std::size_t used = head.size() + 2 + tail.size();
  if (used + shortest_bar > room) return (head + tail).substr(0, room);
  return head + "  " + bar(done(progress), std::min(room - used, longest_bar)) + tail;
}

std::string progress_sentence(const Progress& progress) {
  return fmt::format("{} ({} %)", fmt::join(facts(progress), ", "), percent(progress));
}

ProgressStyle progress_style() {
  return redraws_lines(StandardStream::error) ? ProgressStyle::bar : ProgressStyle::lines;
}

void ProgressDisplay::show(const Progress& progress) {
  const bool stopping = stop_.stop_requested();
  if (style_ == ProgressStyle::bar) {
    // Back to the line's start, the line, and whatever an earlier, longer one left behind it erased.
    tell_raw(fmt::format("\r{}\x1b[K", bar_line(progress, terminal_columns(), stopping)));
    drawn_ = true;
  } else if (style_ == ProgressStyle::lines) {
    if (stopping && !said_stopping_) {
      tell("stopping after the trials in flight; a second signal ends at once");
      said_stopping_ = true;
    } else if (!stopping && progress.elapsed >= last_line_ + seconds_between_lines &&
               progress.completed < progress.requested) {
      tell(progress_sentence(progress));
      last_line_ = progress.elapsed;
    }
  }
}

void ProgressDisplay::clear() {
  if (drawn_) tell_raw("\r\x1b[K");
  drawn_ = false;
}

}  // namespace steerstat
