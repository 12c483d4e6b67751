// A service that tests kill: takes the specs in a directory, prints the id of each study once it is acknowledged, runs
// them all and ends.
//
//   service_process DATA SPECS

#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "service/study_service.hpp"

namespace steerstat {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

int serve(const std::filesystem::path& data, const std::filesystem::path& specs) {
  ServiceLimits limits;
  limits.disk_headroom = 0;
  StudyService service(data, 2, limits, [](const std::string& line) { std::cerr << line << std::endl; });
  std::vector<std::string> ids;
  for (const auto& spec : std::filesystem::directory_iterator(specs)) {
    ids.push_back(service.submit(text_of(spec.path())).state.id);
    std::cout << ids.back() << std::endl;  // flushed: a kill takes nothing of it along
  }
  for (const std::string& id : ids) {
    StudyState state = service.state(id).value();
    while (!is_over(state.status)) {
      state = service.wait_for_change(id, state.revision, std::chrono::seconds(1)).value();
    }
    if (state.status != StudyStatus::succeeded) {
      std::cerr << id << ": " << state.failure.value_or("") << std::endl;
      return 1;
    }
  }
  return 0;
}

}  // namespace
}  // namespace steerstat

int main(int count, char** words) {
  if (count != 3) return 2;
  try {
    return steerstat::serve(words[1], words[2]);
  } catch (const std::exception& problem) {
    std::cerr << problem.what() << std::endl;
    return 1;
  }
}
