#include "process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace steerstat::testing {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

int open_or_fail(const std::string& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC, 0644);
  if (descriptor < 0) fail(path);
  return descriptor;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (std::string& text : strings) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

}  // namespace

Scratch::Scratch() {
  std::string name = (std::filesystem::temp_directory_path() / "steerstat-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) fail(name);
  path_ = name;
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Scratch::file(const std::string& name, const std::string& text) const {
  const std::filesystem::path path = path_ / name;
  std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

std::vector<std::string> Scratch::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Process::Process(const std::string& program, const std::vector<std::string>& arguments, Surroundings surroundings)
    : surroundings_(std::move(surroundings)) {
  start(program, arguments);
}

void Process::start(const std::string& program, const std::vector<std::string>& arguments) {
  const int input = open_or_fail(scratch_.file("in", surroundings_.input), O_RDONLY);
  const bool kept = surroundings_.output_device.empty();
  const int output = open_or_fail(kept ? scratch_ / "out" : surroundings_.output_device, O_WRONLY | O_CREAT);
  int error = -1;
  if (surroundings_.columns > 0) {
    winsize size{};
    size.ws_row = 24;
    size.ws_col = static_cast<unsigned short>(surroundings_.columns);
    if (openpty(&terminal_, &error, nullptr, nullptr, &size) != 0) fail("openpty");
    fcntl(terminal_, F_SETFD, FD_CLOEXEC);
    fcntl(error, F_SETFD, FD_CLOEXEC);
  } else {
    error = open_or_fail(scratch_ / "err", O_WRONLY | O_CREAT);
  }
  std::vector<std::string> argument_texts{program};
  argument_texts.insert(argument_texts.end(), arguments.begin(), arguments.end());
  const std::vector<char*> argv = pointers(argument_texts);
  const std::vector<char*> environment = pointers(surroundings_.environment);

  pid_ = fork();
  if (pid_ < 0) fail("fork");
  if (pid_ == 0) {  // nothing here but system calls: other threads' locks may be held
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(error, STDERR_FILENO);
    if (surroundings_.output_closed) close(STDOUT_FILENO);
    const std::string& directory = surroundings_.directory;
    if (directory.empty() || chdir(directory.c_str()) == 0) execve(argv[0], argv.data(), environment.data());
    _exit(127);
  }
  for (const int descriptor : {input, output, error}) close(descriptor);
}

Process::~Process() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (terminal_ >= 0) close(terminal_);
}

void Process::send(int signal) const {
  if (kill(pid_, signal) != 0) fail("kill");
}

bool Process::read_terminal(std::chrono::milliseconds patience) {
  pollfd waiting{terminal_, POLLIN, 0};
  if (poll(&waiting, 1, static_cast<int>(patience.count())) <= 0) return true;
  char buffer[4096];
  const ssize_t count = read(terminal_, buffer, sizeof buffer);
  if (count <= 0) return false;  // EIO: the other side is closed
  shown_.append(buffer, static_cast<std::size_t>(count));
  return true;
}

bool Process::shows(const std::string& text) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (shown_.find(text) == std::string::npos) {
    if (std::chrono::steady_clock::now() > deadline || !read_terminal(std::chrono::milliseconds(100))) return false;
  }
  return true;
}

Ending Process::wait() {
  if (terminal_ >= 0) {
    while (read_terminal(std::chrono::minutes(5))) {
    }
  }
  int status = 0;
  if (waitpid(pid_, &status, 0) < 0) fail("waitpid");
  pid_ = -1;
  Ending ending;
  if (WIFEXITED(status)) ending.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ending.signal = WTERMSIG(status);
  if (surroundings_.output_device.empty()) ending.out = read_file(scratch_ / "out");
  ending.err = terminal_ >= 0 ? shown_ : read_file(scratch_ / "err");
  return ending;
}

int wanted_kills() {
  const char* const asked = std::getenv("STEERSTAT_KILLS");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  return asked == nullptr ? 20 : std::atoi(asked);
}

Ending steerstat(const std::vector<std::string>& arguments, const Surroundings& surroundings) {
  return Process(STEERSTAT_PROGRAM, arguments, surroundings).wait();
}

}  // namespace steerstat::testing
