#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "file_content.hpp"
#include "process.hpp"
#include "store/result_file.hpp"

namespace steerstat::testing {

/// A study that is run into `out.h5`, whatever befalls the run, and the result it must have in the end.
class FaultCase : public ::testing::Test {
 protected:
  /// The specs are of lockstep studies whose trials differ in length; they retain and audit.
  static std::string spec_of(std::uint64_t trials, std::uint64_t seed = 1) {
    return R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
               "initial_state": {"q2": {"uniform": [-3.1, 3.1]}}, "horizon": 60, "audit": {"trials": 2},
               "retain": {"trajectories": {"first": 1, "failed": 2}}, "sampling": {"trials": )" +
           std::to_string(trials) + R"(, "seed": )" + std::to_string(seed) + "}}";
  }

  void set_spec(const std::string& text) { spec_ = scratch_.file("spec.json", text); }

  [[nodiscard]] std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run", spec_, "-o", out_.string(), "--threads", "2", "--no-progress"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// The content of the result of an undisturbed run.
  std::map<std::string, std::string> undisturbed() {
    const std::string path = scratch_ / "undisturbed.h5";
    const Ending ending = steerstat({"run", spec_, "-o", path, "--threads", "2", "--no-progress"});
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    return lasting_content_of(path);
  }

  /// Resumes, and expects the run to end well and to leave nothing but the undisturbed result.
  Ending expect_recovery(const std::map<std::string, std::string>& undisturbed) {
    Ending ending = steerstat(arguments({"--resume"}));
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    expect_undisturbed(undisturbed);
    return ending;
  }

  void expect_undisturbed(const std::map<std::string, std::string>& undisturbed) {
    EXPECT_TRUE(lasting_content_of(out_) == undisturbed) << "the result differs from an undisturbed run's";
    EXPECT_NO_THROW(read_result(out_));
    EXPECT_FALSE(std::filesystem::exists(parts_));
    for (const std::string& name : scratch_.names()) EXPECT_FALSE(name.starts_with(".tmp-")) << name << " is left";
  }

  /// The names in the directory of shards, sorted; none where there is no such directory.
  [[nodiscard]] std::vector<std::string> parts() const {
    std::vector<std::string> names;
    if (!std::filesystem::exists(parts_)) return names;
    for (const auto& entry : std::filesystem::directory_iterator(parts_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  /// Those of them that are shards.
  [[nodiscard]] std::vector<std::string> shards() const {
    std::vector<std::string> names = parts();
    std::erase_if(names, [](const std::string& name) { return !name.starts_with("trials-"); });
    return names;
  }

  Scratch scratch_;
  std::string spec_;
  std::filesystem::path out_ = scratch_ / "out.h5";
  std::filesystem::path parts_ = scratch_ / "out.h5.parts";
};

}  // namespace steerstat::testing
