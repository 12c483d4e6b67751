// Specs that the decoder must take or refuse, and what it must say of those it refuses. The schema is held to the same
// corpus: it takes good/ and refuses bad/; what bad_semantics/ holds is beyond a schema, what malformed/ holds is not
// JSON.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

const fs::path corpus = STEERSTAT_SOURCE_DIR "/tests/study/corpus";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<fs::path> specs_in(const std::string& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(corpus / folder)) {
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string name_of_file(const ::testing::TestParamInfo<fs::path>& info) {
  return info.param.stem().string();
}

class GoodSpec : public ::testing::TestWithParam<fs::path> {};

TEST_P(GoodSpec, DecodesAndComesBackFromItsCanonicalForm) {
  Study study;
  ASSERT_NO_THROW(study = decode_study(text_of(GetParam()), {}));
  const std::string canonical = canonical_spec(study);
  const Study again = decode_study(canonical, {});
  EXPECT_EQ(again, study);
  EXPECT_EQ(canonical_spec(again), canonical);
}

INSTANTIATE_TEST_SUITE_P(Corpus, GoodSpec, ::testing::ValuesIn(specs_in("good")), name_of_file);

class BadSpecFile : public ::testing::TestWithParam<fs::path> {};

TEST_P(BadSpecFile, IsRefusedWithExactlyTheseErrors) {
  fs::path expected = GetParam();
  expected.replace_extension(".errors");
  try {
    decode_study(text_of(GetParam()), {});
    FAIL() << "accepted";
  } catch (const BadSpec& bad) {
    EXPECT_FALSE(bad.errors().empty());
    EXPECT_EQ(std::string(bad.what()) + '\n', text_of(expected));
  }
}

INSTANTIATE_TEST_SUITE_P(Schema, BadSpecFile, ::testing::ValuesIn(specs_in("bad")), name_of_file);
INSTANTIATE_TEST_SUITE_P(Semantics, BadSpecFile, ::testing::ValuesIn(specs_in("bad_semantics")), name_of_file);
INSTANTIATE_TEST_SUITE_P(Malformed, BadSpecFile, ::testing::ValuesIn(specs_in("malformed")), name_of_file);

}  // namespace
}  // namespace steerstat
