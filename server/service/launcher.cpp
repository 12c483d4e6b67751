#include "service/launcher.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/errors.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

// The shell notes what the kernel says of it, and becomes the command: the same process.
constexpr const char* script = R"(read -r stat </proc/$$/stat && echo "$stat" >"$1" && shift && exec "$@")";

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return std::move(text).str();
}

struct Identity {
  pid_t process{0};
  std::uint64_t began{0};
  char state{'Z'};
};

/// Of what /proc/PROCESS/stat says [proc(5)]: the number, the name in parentheses, the state, and as the 22nd field
/// when it began. @return nothing for another text
std::optional<Identity> identity_of(const std::string& stat) {
  const std::size_t name_end = stat.rfind(") ");
  if (name_end == std::string::npos) return std::nullopt;
  Identity identity;
  std::istringstream(stat) >> identity.process;
  std::istringstream rest(stat.substr(name_end + 2));
  std::string skipped;
  rest >> identity.state;
  for (int field = 4; field < 22; ++field) rest >> skipped;
  rest >> identity.began;
  if (!rest || identity.process <= 1) return std::nullopt;
  return identity;
}

bool lives(pid_t process, std::uint64_t began) {
  const auto now = identity_of(text_of(fmt::format("/proc/{}/stat", process)));
  return now && now->began == began && now->state != 'Z';
}

/// What a process is started with, released at the end.
struct SpawnSettings {
  SpawnSettings() {
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_init(&actions);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawnattr_t attributes{};
  posix_spawn_file_actions_t actions{};
};

}  // namespace

std::string Launcher::text() const {
  return fmt::format("{}", fmt::join(prefix, " "));
}

LaunchedProcess LaunchedProcess::launch(const std::vector<std::string>& command, const fs::path& note,
                                        const fs::path& log) {
  std::vector<std::string> words{"sh", "-c", script, "sh", note.string()};
  words.insert(words.end(), command.begin(), command.end());
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  SpawnSettings settings;
  sigset_t usual;
  sigemptyset(&usual);
  sigset_t ignored;
  sigemptyset(&ignored);
  sigaddset(&ignored, SIGPIPE);
  posix_spawnattr_setsigmask(&settings.attributes, &usual);
  posix_spawnattr_setsigdefault(&settings.attributes, &ignored);
  posix_spawnattr_setpgroup(&settings.attributes, 0);
  posix_spawnattr_setflags(&settings.attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  posix_spawn_file_actions_addopen(&settings.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&settings.actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&settings.actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, "/bin/sh", &settings.actions, &settings.attributes, arguments.data(), environ);
  if (error != 0) {
    throw RunFailure(fmt::format("cannot launch {} ({})", command.front(), std::generic_category().message(error)));
  }
  return {process, 0, true};
}

std::optional<LaunchedProcess> LaunchedProcess::find(const fs::path& note) {
  const auto identity = identity_of(text_of(note));
  if (!identity || !lives(identity->process, identity->began)) return std::nullopt;
  return LaunchedProcess{identity->process, identity->began, false};
}

void LaunchedProcess::send(int signal) const {
  if (!has_ended_) kill(-process_, signal);
}

bool LaunchedProcess::has_ended() {
  if (has_ended_) return true;
  if (!is_child_) return has_ended_ = !lives(process_, began_);
  int status = 0;
  const pid_t ended = waitpid(process_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return false;
  has_ended_ = true;
  if (ended > 0) exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

}  // namespace steerstat
