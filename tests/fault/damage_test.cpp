#include <csignal>
#include <fstream>
#include <iostream>
#include <random>

#include "../nightly.hpp"
#include "fault_case.hpp"

namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class Damage : public FaultCase {
 protected:
  /// Enough for two shards on any machine: one is written, at the latest, when 65,536 trials wait.
  static constexpr std::uint64_t trials = 140000;

  /// Kills a run that has kept two shards: its study's file was renamed first.
  void interrupt() {
    Surroundings surroundings;
    surroundings.environment.emplace_back("STEERSTAT_FAILPOINT=after-rename:3:kill");
    ASSERT_EQ(steerstat(arguments(), surroundings).signal, SIGKILL);
    ASSERT_EQ(shards().size(), 2U);
  }

  static void overwrite(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }

  /// Copies what the interrupted run left, to be damaged again and again.
  void restore(const fs::path& copy) const {
    fs::remove_all(parts_);
    fs::remove(out_);
    fs::copy(copy, parts_);
  }
};

TEST_F(Damage, OfAnyShardIsFoundAndItsTrialsRunAgain) {
  constexpr unsigned seed = 17;
  std::cout << "seed " << seed << '\n';
  std::mt19937 generator(seed);
  set_spec(spec_of(trials));
  const auto expected = undisturbed();
  interrupt();
  const fs::path copy = scratch_ / "copy";
  fs::copy(parts_, copy);
  for (int time = 0; time < (is_sanitized ? 4 : 12); ++time) {
    restore(copy);
    const std::vector<std::string> names = shards();
    const fs::path shard = parts_ / names[generator() % names.size()];
    std::string bytes = read_file(shard);
    if (time % 2 == 0) {
      bytes[generator() % bytes.size()] ^= static_cast<char>(1 << (generator() % 8));
    } else {
      bytes.resize(generator() % bytes.size());
    }
    overwrite(shard, bytes);
    SCOPED_TRACE(shard.string() + (time % 2 == 0 ? ", a bit flipped" : ", cut short"));
    const Ending ending = expect_recovery(expected);
    EXPECT_THAT(ending.err, HasSubstr("damaged-" + shard.filename().string()));
  }
}

TEST_F(Damage, OfTheStudysOwnFileCostsNothing) {
  set_spec(spec_of(trials));
  const auto expected = undisturbed();
  interrupt();
  overwrite(parts_ / "study.h5", "damaged");
  const Ending ending = expect_recovery(expected);
  EXPECT_THAT(ending.err, HasSubstr("damaged-study.h5"));
  EXPECT_THAT(ending.err, Not(HasSubstr("resuming after 0 of")));
}

TEST_F(Damage, ThatTookAShardAwayIsMended) {
  set_spec(spec_of(trials));
  const auto expected = undisturbed();
  interrupt();
  fs::remove(parts_ / shards().front());
  expect_recovery(expected);
}

}  // namespace
}  // namespace steerstat::testing
