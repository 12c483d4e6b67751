#include "machine.hpp"

#include <fmt/format.h>

#include <fstream>
#include <thread>

#include "peer.hpp"

namespace steerstat::bench {
namespace {

/// The value of the first line of `file` that begins with `key`; "unknown" without one.
std::string value_of(const std::string& file, const std::string& key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(':');
    if (line.starts_with(key) && colon != std::string::npos)
      return line.substr(line.find_first_not_of(" \t", colon + 1));
  }
  return "unknown";
}

std::string load_average() {
  std::ifstream file("/proc/loadavg");
  std::string minute;
  return file >> minute ? minute : "unknown";
}

}  // namespace

std::string description_of_machine() {
  const std::string cpuinfo = "/proc/cpuinfo";
  return fmt::format(
      "processor  {}, family {} model {}, {} threads; load average {}\n"
      "compiler   {}, flags {}\n"
      "peers      the same and {}\n",
      value_of(cpuinfo, "model name"), value_of(cpuinfo, "cpu family"), value_of(cpuinfo, "model\t"),
      std::thread::hardware_concurrency(), load_average(), STEERSTAT_COMPILER, STEERSTAT_FLAGS, peer_flags());
}

}  // namespace steerstat::bench
