#include "store/shard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "sample_result.hpp"
#include "store/result_file.hpp"

namespace steerstat {
namespace {

using namespace testing_store;
using ::testing::HasSubstr;

class ShardFile : public testing::Test {
 protected:
  ShardFile() {
    std::mt19937_64 generator(3);
    for (int i = 0; i < 40; ++i) outcomes_.push_back(made_up_outcome(generator));
    write_shard(directory_.path(), origin_, 64, outcomes_, 1.5);
  }

  /// What read_shard says of the file, "" where it reads it.
  [[nodiscard]] std::string complaint(const ShardOrigin& origin, std::uint64_t trials) const {
    try {
      read_shard(path_, origin, trials);
      return "";
    } catch (const RunFailure& failure) {
      return failure.what();
    }
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "trials-000000000064-000000000104.h5";
  Study study_ = sample_study(100);
  ShardOrigin origin_ = origin_of(study_);
  std::vector<TrialOutcome> outcomes_;
};

TEST_F(ShardFile, GivesBackTheSameBits) {
  EXPECT_EQ(entries_in(directory_.path()), 1U);
  const Shard shard = read_shard(path_, origin_, 300);
  EXPECT_EQ(shard.begin, 64U);
  EXPECT_EQ(shard.wall_s, 1.5);
  EXPECT_EQ(shard.outcomes, outcomes_);
}

TEST_F(ShardFile, IsTheSameBytesWhenWrittenAgain) {
  const std::string bytes = bytes_of(path_);
  write_shard(directory_.path(), origin_, 64, outcomes_, 1.5);
  EXPECT_EQ(bytes_of(path_), bytes);
}

TEST_F(ShardFile, HoldsNoTimesThatWouldTellWhenItWasWritten) {
  // An object's header, version 2: OHDR, 2, flags, of which bit 5 says that times follow
  // [The HDF Group, HDF5 File Format Specification 3.0, IV.A.1.b].
  const std::string bytes = bytes_of(path_);
  const std::string header{'O', 'H', 'D', 'R', 2};
  std::size_t headers = 0;
  for (std::size_t at = bytes.find(header); at != std::string::npos; at = bytes.find(header, at + 1)) {
    EXPECT_EQ(static_cast<unsigned char>(bytes.at(at + header.size())) & 0x20U, 0U) << "at " << at;
    ++headers;
  }
  EXPECT_GT(headers, 3U);
}

TEST_F(ShardFile, OfAStudyIsOneOfEveryExtensionOfIt) {
  EXPECT_EQ(complaint(origin_of(sample_study(1000)), 3000), "");
}

TEST_F(ShardFile, OfAnotherStudyOrVersionIsRefused) {
  Study other = study_;
  other.sampling.seed = 99;
  EXPECT_THAT(complaint(origin_of(other), 300), HasSubstr("another study's"));
  ShardOrigin later = origin_;
  later.engine_version = "99.0.0";
  EXPECT_THAT(complaint(later, 300), HasSubstr("engine version"));
  EXPECT_EQ(origin_.engine_version, engine_version());
}

TEST_F(ShardFile, BeyondTheLastTrialIsRefused) {
  EXPECT_EQ(complaint(origin_, 104), "");
  EXPECT_THAT(complaint(origin_, 103), HasSubstr("beyond the last"));
}

TEST_F(ShardFile, IsRefusedWhicheverBitFlips) {
  const std::string bytes = bytes_of(path_);
  std::mt19937_64 generator(7);
  for (int flip = 0; flip < 1000; ++flip) {
    std::string damaged = bytes;
    const std::size_t position = generator() % damaged.size();
    damaged[position] = static_cast<char>(damaged[position] ^ (1 << (generator() % 8)));
    set_bytes(path_, damaged);
    EXPECT_THAT(complaint(origin_, 300), HasSubstr("damaged")) << "byte " << position;
  }
}

TEST_F(ShardFile, IsRefusedWhereverItIsCutShort) {
  const std::string bytes = bytes_of(path_);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 200) {
    set_bytes(path_, bytes.substr(0, size));
    EXPECT_THAT(complaint(origin_, 300), HasSubstr("damaged")) << "cut to " << size << " bytes";
  }
}

TEST_F(ShardFile, ThatIsAResultFileIsRefused) {
  write_result(path_, study_, made_up_result(study_));
  EXPECT_THAT(complaint(origin_, 300), HasSubstr("filetype"));
}

TEST(ShardName, SortsAsTheTrialsDo) {
  EXPECT_EQ(shard_name(0, 65536), "trials-000000000000-000000065536.h5");
  EXPECT_LT(shard_name(999, 1000), shard_name(1000, 1001));
  EXPECT_LT(shard_name(99'999'999, 100'000'000), shard_name(100'000'000, 100'000'128));
}

}  // namespace
}  // namespace steerstat
