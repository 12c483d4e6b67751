#pragma once

#include <filesystem>
#include <string_view>

#include "core/errors.hpp"

namespace steerstat {

enum class StandardStream : int { output = 1, error = 2 };

/// Makes the standard streams safe to write to: a closed one gets a descriptor that refuses writes, so that no file
/// opened later is mistaken for it, and a reader that goes away is an error to report, not a signal to die of.
void secure_standard_streams();

/// Lets nothing that is written to the standard streams arrive anywhere.
void mute_standard_streams();

/// Whoever read standard output stopped reading, as `head` does.
class ReaderGone : public RunFailure {
 public:
  using RunFailure::RunFailure;
};

/// Writes results to standard output. @throws RunFailure where not all of it arrives (closed, full disk)
void print(std::string_view text);

/// Writes one message, "steerstat: MESSAGE" and a line end, to standard error. Never fails: there is nowhere to say so.
void tell(std::string_view message);

/// Writes text to standard error as it is.
void tell_raw(std::string_view text);

/// Does one of several things of which each should be tried: a failure is told, not thrown.
/// @return whether it was done
template <class Action>
bool attempt(const Action& action) {
  try {
    action();
    return true;
  } catch (const RunFailure& failure) {
    tell(failure.what());
    return false;
  }
}

/// Replaces the file at `path` whole or not at all, as write_whole_file() does. @throws RunFailure
void write_text(const std::filesystem::path& path, std::string_view text);

/// Whether the stream is a terminal that moves its cursor on command.
bool redraws_lines(StandardStream stream);

/// Whether colours are welcome on the stream: a terminal, and NO_COLOR not set (https://no-color.org). Never on ranks.
bool wants_colour(StandardStream stream);

/// Width of the terminal on standard error, 80 where it does not say.
unsigned terminal_columns();

}  // namespace steerstat
