#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace steerstat::testing {

/// A directory of its own for one test, removed with everything in it at the test's end.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  /// The path of a file in it.
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file into it. @return its path
  std::string file(const std::string& name, const std::string& text) const;
  /// The names of all files in it, sorted.
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::filesystem::path& path);

/// How a process ended, and what it said.
struct Ending {
  int exit_code{-1};  ///< -1 where a signal ended it
  int signal{0};      ///< the signal that ended it, or 0
  std::string out;    ///< standard output
  std::string err;    ///< standard error
};

/// What a process is given.
struct Surroundings {
  std::string input{};          ///< its standard input
  std::string output_device{};  ///< standard output goes here, e.g. /dev/full; "": into Ending::out
  bool output_closed{false};    ///< it starts without a standard output
  std::string directory{};      ///< its working directory; "": this one
  unsigned columns{0};          ///< standard error is a terminal this wide; 0: a file
  std::vector<std::string> environment{"TERM=xterm", "LANG=C.UTF-8"};
};

/// A process under way. Standard error, where it is a terminal, is read as it comes.
class Process {
 public:
  Process(const std::string& program, const std::vector<std::string>& arguments, Surroundings surroundings = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// Waits until its terminal has shown `text`. @return whether it has, within a minute
  bool shows(const std::string& text);
  Ending wait();

 private:
  void start(const std::string& program, const std::vector<std::string>& arguments);
  bool read_terminal(std::chrono::milliseconds patience);

  Scratch scratch_;
  Surroundings surroundings_;
  pid_t pid_{-1};
  int terminal_{-1};
  std::string shown_;
};

/// How many kills a test is to survive: 20, or as the environment says (tests/run nightly: 200).
int wanted_kills();

/// Runs `steerstat` to its end.
Ending steerstat(const std::vector<std::string>& arguments, const Surroundings& surroundings = {});

}  // namespace steerstat::testing
