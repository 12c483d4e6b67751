#include <gtest/gtest.h>

#include <sys/resource.h>

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "../nightly.hpp"
#include "file_content.hpp"
#include "process.hpp"
#include "store/result_file.hpp"
#include "study/spec_json.hpp"

namespace steerstat::testing {
namespace {

/// How many shards a merge is to take: 300, 100 beside a sanitizer, or as the environment says (tests/run nightly:
/// 10,000).
std::uint32_t wanted_shards() {
  const char* const asked = std::getenv("STEERSTAT_SHARDS");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  if (asked == nullptr && is_sanitized) return 100;
  return asked == nullptr ? 300 : static_cast<std::uint32_t>(std::atoi(asked));
}

/// Files open at once, as long as it lives.
class FewFiles {
 public:
  explicit FewFiles(rlim_t most) {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit few{most, before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewFiles() { setrlimit(RLIMIT_NOFILE, &before_); }
  FewFiles(const FewFiles&) = delete;
  FewFiles& operator=(const FewFiles&) = delete;

 private:
  rlimit before_{};
};

/// [KiB] of the largest process that has ended.
long largest_child() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss;
}

TEST(MergeOfManyShards, TakesTheMemoryAndTheFilesOfFew) {
  const Scratch scratch;
  const std::string out = scratch / "out.h5";
  const auto merge = [&](const std::vector<std::string>& files) {
    std::vector<std::string> words{"merge", "-o", out};
    words.insert(words.end(), files.begin(), files.end());
    return steerstat(words);
  };
  const std::uint32_t many = wanted_shards();
  const Study study = decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "integrator": {"method": "cvode"},
      "audit": {"trials": 0}, "sampling": {"trials": )" +
                                       std::to_string(16 * std::uint64_t{many}) + "}}",
                                   {});
  // Outcomes that nobody simulated: merge takes them as they are, since it audits and retains none.
  std::mt19937_64 generator(1);
  const auto write = [&](const StudyShare& share) {
    StudyResult result;
    result.share = share;
    result.threads = 1;
    const TrialRange range = trials_of(study, share);
    for (std::uint64_t index = range.begin; index < range.end; ++index) {
      TrialOutcome outcome;
      outcome.status = Status::timeout;
      outcome.end_time = static_cast<double>(index);
      outcome.effort = static_cast<double>(generator());
      result.trials.index.push_back(index);
      result.trials.outcomes.push_back(outcome);
    }
    const std::string path = scratch / (std::to_string(share.count) + "-" + std::to_string(share.number));
    write_result(path, study, result);
    return path;
  };
  const auto write_all = [&](std::uint32_t count) {
    std::vector<std::string> files;
    generator.seed(1);
    for (std::uint32_t number = 1; number <= count; ++number) files.push_back(write({number, count}));
    return files;
  };
  const FewFiles limit(24);
  ASSERT_EQ(merge(write_all(10)).exit_code, 0);
  const auto of_few = lasting_content_of(out);
  [[maybe_unused]] const long memory_for_few = largest_child();
  const Ending ending = merge(write_all(many));
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_TRUE(lasting_content_of(out) == of_few);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they keep what is freed
  EXPECT_LT(largest_child(), memory_for_few + 8 * 1024);
#endif
}

}  // namespace
}  // namespace steerstat::testing
