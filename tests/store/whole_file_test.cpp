#include "store/whole_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "core/errors.hpp"
#include "sample_result.hpp"
#include "store/result_file.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;
using namespace testing_store;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::span<const std::byte> bytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

class WholeFile : public testing::Test {
 protected:
  /// What require_writable says of a path, "" where it has no objection.
  static std::string complaint(const fs::path& path) {
    try {
      require_writable(path);
      return "";
    } catch (const RunFailure& failure) {
      return failure.what();
    }
  }

  TemporaryDirectory directory_;
  fs::path path_ = directory_.path() / "file";
};

/// Gives up root's rights, which no permission stops, until the end of the scope.
class WithoutPrivileges {
 public:
  WithoutPrivileges() : user_(geteuid()) {
    if (user_ == 0) changed_ = seteuid(65534) == 0;
  }
  ~WithoutPrivileges() {
    if (changed_) changed_ = seteuid(user_) == 0;
  }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;

 private:
  uid_t user_;
  bool changed_{false};
};

TEST_F(WholeFile, HoldsItsPartsOneAfterTheOther) {
  const std::string first = "first ";
  const std::string second = "second";
  write_whole_file(path_, {bytes(first), {}, bytes(second)});
  EXPECT_EQ(bytes_of(path_), "first second");
  const std::vector<std::byte> read = read_whole_file(path_);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(read.data()), read.size()), "first second");
}

TEST_F(WholeFile, MayBeEmpty) {
  write_whole_file(path_, {});
  EXPECT_TRUE(fs::exists(path_));
  EXPECT_TRUE(read_whole_file(path_).empty());
}

TEST_F(WholeFile, LeavesTheOldOneAsItWasWhenTheDiskIsFull) {
  set_bytes(path_, "old");
  const std::string large(100000, 'x');
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 50000;  // stands in for a full disk: writes fail part of the way
  const auto old_action = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(write_whole_file(path_, {bytes(large)}), RunFailure);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_action);
  EXPECT_EQ(bytes_of(path_), "old");
  EXPECT_EQ(entries_in(directory_.path()), 1U);
}

TEST_F(WholeFile, ReplacesWhatALinkNamesAndKeepsTheLink) {
  const fs::path link = directory_.path() / "link";
  set_bytes(path_, "old");
  fs::create_symlink("file", link);
  write_whole_file(link, {bytes(std::string("new"))});
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(bytes_of(path_), "new");
}

TEST_F(WholeFile, FollowsTheUsersMaskOfPermissions) {
  const mode_t before = umask(0027);
  write_whole_file(path_, {});
  umask(before);
  EXPECT_EQ(fs::status(path_).permissions(), fs::perms(0640));
}

TEST_F(WholeFile, WritesADeviceInPlace) {
  write_whole_file("/dev/null", {bytes(std::string("gone"))});
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(write_whole_file("/dev/full", {bytes(std::string("no room"))}), RunFailure);
}

TEST_F(WholeFile, IsFoundWritableWithoutBeingTouched) {
  EXPECT_EQ(complaint(path_), "");
  EXPECT_FALSE(fs::exists(path_));
  set_bytes(path_, "old");
  EXPECT_EQ(complaint(path_), "");
  EXPECT_EQ(bytes_of(path_), "old");
  EXPECT_EQ(entries_in(directory_.path()), 1U);
  EXPECT_EQ(complaint("/dev/null"), "");
}

TEST_F(WholeFile, IsLookedForWhereARelativeNameSays) {
  const fs::path before = fs::current_path();
  fs::current_path(directory_.path());
  EXPECT_EQ(complaint("plain-name"), "");
  write_whole_file("plain-name", {});
  fs::current_path(before);
  EXPECT_TRUE(fs::exists(directory_.path() / "plain-name"));
}

TEST_F(WholeFile, IsRefusedBeforehandWhereItCannotBe) {
  EXPECT_THAT(complaint(directory_.path()), HasSubstr("Is a directory"));
  EXPECT_THAT(complaint(directory_.path() / "missing" / "file"),
              AllOf(HasSubstr("there is no directory"), HasSubstr("create it")));
  set_bytes(path_, "");
  EXPECT_THAT(complaint(path_ / "below"), HasSubstr("Not a directory"));
  EXPECT_THAT(complaint(directory_.path() / std::string(300, 'x')), HasSubstr("File name too long"));
  EXPECT_THAT(complaint(""), HasSubstr("without a name"));
}

TEST_F(WholeFile, IsRefusedBeforehandWithoutPermission) {
  set_bytes(path_, "");
  fs::permissions(directory_.path(), fs::perms::owner_all | fs::perms::others_all);
  fs::permissions(path_, fs::perms::owner_read | fs::perms::others_read);
  const fs::path closed = directory_.path() / "closed";
  fs::create_directory(closed);
  fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec);
  std::string of_file;
  std::string of_directory;
  {
    const WithoutPrivileges unprivileged;
    of_file = complaint(path_);
    of_directory = complaint(closed / "file");
  }
  fs::permissions(closed, fs::perms::owner_all);
  EXPECT_THAT(of_file, HasSubstr("Permission denied"));
  EXPECT_THAT(of_directory, HasSubstr("Permission denied"));
}

}  // namespace
}  // namespace steerstat
