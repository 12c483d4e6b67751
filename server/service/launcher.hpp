#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace steerstat {

/// How studies are run through other programs: PREFIX PROGRAM run ..., such as `srun -N4 steerstat run ...`.
struct Launcher {
  std::vector<std::string> prefix;  ///< the command's words
  std::string program;              ///< the path of steerstat

  /// "srun -N4"
  [[nodiscard]] std::string text() const;
};

/// A process that was launched, a group of its own, known by a file: whoever starts anew finds it there and does not
/// launch it twice. Not thread-safe.
class LaunchedProcess {
 public:
  /// Launches `command` with its output going to `log`. It notes itself in `note` before it becomes the command, so
  /// that there is no moment at which it runs and nobody could know.
  /// @throws RunFailure where no process can be made
  static LaunchedProcess launch(const std::vector<std::string>& command, const std::filesystem::path& note,
                                const std::filesystem::path& log);

  /// The process that `note` tells of, launched by another one that has died; nothing where it does not live.
  static std::optional<LaunchedProcess> find(const std::filesystem::path& note);

  /// Signals all of its group.
  void send(int signal) const;

  /// Whether it has ended. How, is known of a child alone.
  [[nodiscard]] bool has_ended();

  /// As a shell tells it, 128 + its number for a signal; nothing for what is no child of this process.
  [[nodiscard]] std::optional<int> exit_code() const { return exit_code_; }

 private:
  LaunchedProcess(pid_t process, std::uint64_t began, bool is_child)
      : process_(process), began_(began), is_child_(is_child) {}

  pid_t process_;
  std::uint64_t began_;  // by the kernel's clock: with its number, it is no other process
  bool is_child_;
  bool has_ended_{false};
  std::optional<int> exit_code_{};
};

}  // namespace steerstat
