#pragma once

#include <stop_token>
#include <string>

#include "study/run.hpp"

namespace steerstat {

/// One line for a terminal, at most `columns` - 1 wide: a bar, the count, the rate and the time left, as far as they
/// fit.
/// @param stopping  say that the run is ending early instead of when it ends
std::string bar_line(const Progress& progress, unsigned columns, bool stopping);

/// The same as a sentence, for a log.
std::string progress_sentence(const Progress& progress);

/// How a run shows its progress.
enum class ProgressStyle {
  none,
  bar,    ///< one line, redrawn in place
  lines,  ///< a line every five seconds
};

/// The style that suits standard error: a bar on a terminal that can redraw a line, else lines.
ProgressStyle progress_style();

/// Shows a run's progress on standard error. Calls may come from any thread, one at a time.
class ProgressDisplay {
 public:
  ProgressDisplay(ProgressStyle style, std::stop_token stop) : style_(style), stop_(std::move(stop)) {}
  ~ProgressDisplay() { clear(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const Progress& progress);

  /// Takes the bar off the screen.
  void clear();

 private:
  ProgressStyle style_;
  std::stop_token stop_;
  bool drawn_{false};
  bool said_stopping_{false};
  double last_line_{0.0};  ///< [s] since the run's start
};

}  // namespace steerstat
