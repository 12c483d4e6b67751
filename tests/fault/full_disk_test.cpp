#include "fault_case.hpp"

namespace steerstat::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;

class FullDisk : public FaultCase {
 protected:
  static Ending bash(const std::string& script, const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"-c", script};
    words.insert(words.end(), arguments.begin(), arguments.end());
    Surroundings surroundings;
    surroundings.environment.emplace_back("PATH=/usr/sbin:/usr/bin:/sbin:/bin");
    return Process("/bin/bash", words, surroundings).wait();
  }
};

TEST_F(FullDisk, WhereFilesMayNotGrowFailsClearlyAndKeepsWhatIsFinished) {
  set_spec(spec_of(20000));
  const auto expected = undisturbed();
  bool failed_with_shards = false;
  const std::uintmax_t size = fs::file_size(scratch_ / "undisturbed.h5") / 1024;
  for (const std::uintmax_t kibibytes : {std::uintmax_t{1}, std::uintmax_t{8}, size / 4, size / 2, size - 1}) {
    SCOPED_TRACE(std::to_string(kibibytes) + " KiB a file");
    std::vector<std::string> words = arguments();
    words.insert(words.begin(), STEERSTAT_PROGRAM);
    const Ending ending = bash("trap '' XFSZ; ulimit -f " + std::to_string(kibibytes) + R"(; exec "$0" "$@")", words);
    ASSERT_EQ(ending.exit_code, 4) << ending.err;
    EXPECT_THAT(ending.err, HasSubstr("File too large"));
    EXPECT_FALSE(fs::exists(out_));
    if (!shards().empty()) {
      failed_with_shards = true;
      EXPECT_THAT(ending.err, HasSubstr("kept in " + parts_.string()));
    }
    expect_recovery(expected);
    fs::remove(out_);
  }
  EXPECT_TRUE(failed_with_shards) << "no limit let a shard pass and stopped the result";
}

/// A script for a mount namespace of its own: a study on a file system of $SIZE KiB, then again with room.
constexpr const char* on_small_disk = R"(
  set -u
  mount -t tmpfs -o size="$SIZE"k none "$DISK" || exit 100
  "$0" "$@" -o "$DISK/out.h5" 2>"$LOG"; first=$?
  ls -A "$DISK" "$DISK/out.h5.parts" >>"$LOG" 2>/dev/null
  mount -o remount,size=100m "$DISK" || exit 101
  "$0" "$@" -o "$DISK/out.h5" --resume || exit 102
  [ -e "$DISK/out.h5.parts" ] && exit 103
  cp "$DISK/out.h5" "$RESULT" || exit 104
  exit $first)";

TEST_F(FullDisk, OfAnySizeFailsClearlyAndKeepsWhatIsFinished) {
  if (bash("unshare -rm mount -t tmpfs none /mnt", {}).exit_code != 0) {
    GTEST_SKIP() << "this machine lets nobody but root mount a small disk";
  }
  set_spec(spec_of(20000));
  const auto expected = undisturbed();
  const fs::path disk = scratch_ / "disk";
  fs::create_directory(disk);
  int failed = 0;
  for (const int kibibytes : {4, 16, 64, 256, 1024, 2048, 4096, 6000, 8192, 60000}) {
    SCOPED_TRACE(std::to_string(kibibytes) + " KiB");
    const std::string variables = "export SIZE=" + std::to_string(kibibytes) + " DISK='" + disk.string() + "' LOG='" +
                                  (scratch_ / "log") + "' RESULT='" + out_.string() + "'; ";
    const std::vector<std::string> words{on_small_disk, STEERSTAT_PROGRAM, "run", spec_, "--threads",
                                         "2",           "--no-progress"};
    const Ending ending = bash(variables + R"(exec unshare -rm bash -c "$0" "$@")", words);
    const std::string log = read_file(scratch_ / "log");
    ASSERT_THAT(ending.exit_code, AnyOf(0, 4)) << log << ending.err;
    if (ending.exit_code == 4) {
      ++failed;
      EXPECT_THAT(log, AnyOf(HasSubstr("the disk is full"), HasSubstr("No space left on device")));
      EXPECT_THAT(log, ::testing::Not(HasSubstr(".tmp-")));
    }
    EXPECT_TRUE(lasting_content_of(out_) == expected);
  }
  EXPECT_GE(failed, 5);
}

}  // namespace
}  // namespace steerstat::testing
