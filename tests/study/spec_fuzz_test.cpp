// Mutated specs: whatever the text, the decoder gives a study or says what is wrong, and every study it gives comes
// back from its canonical form.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> specs_below(const std::string& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(STEERSTAT_SOURCE_DIR + folder)) {
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const fs::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    texts.push_back(text.str());
  }
  return texts;
}

// Changes texts by bytes and by the tokens that specs are made of.
class Mutator {
 public:
  // A good spec most of the time, or there would be little left of what makes a study.
  std::string mutated() {
    std::string text = pick(below(4) == 0 ? all_ : good_);
    for (std::size_t i = 1 + below(3); i > 0; --i) mutate(text);
    return text;
  }

 private:
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  template <class Value>
  const Value& pick(const std::vector<Value>& values) {
    return values[below(values.size())];
  }

  void mutate(std::string& text) {
    static const std::vector<std::string> tokens{"{",
                                                 "}",
                                                 "[",
                                                 "]",
                                                 ",",
                                                 ":",
                                                 "\"",
                                                 "null",
                                                 "true",
                                                 "-1",
                                                 "0",
                                                 "1e308",
                                                 "-1e-320",
                                                 "1e999",
                                                 "0.5",
                                                 "NaN",
                                                 "\"sweep\"",
                                                 "[1,2]",
                                                 "{}",
                                                 "[]",
                                                 "\"normal\"",
                                                 "\"uniform\"",
                                                 "\"relative\"",
                                                 "\"trials\"",
                                                 "\"file\"",
                                                 "\"grid\"",
                                                 "\"explicit\"",
                                                 "18446744073709551616",
                                                 "\xC3\xA9",
                                                 "\\u0000",
                                                 "\xFF",
                                                 "{\"sweep\": [1, 2]}",
                                                 "{\"uniform\": [0.5, 1]}"};
    const std::size_t at = below(text.size());
    const std::size_t length = below(std::min<std::size_t>(text.size() - at, 12) + 1);
    switch (below(12)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, pick(tokens));
        break;
      case 2:
        text.replace(at, length, pick(tokens));
        break;
      case 3:
        text.insert(at, text.substr(at, length));
        break;
      case 4:
        if (!text.empty()) text[at] = static_cast<char>(below(256));
        break;
      case 5: {  // crossed with another spec
        const std::string& other = pick(all_);
        const std::size_t start = below(other.size());
        text.replace(at, length, other.substr(start, below(60)));
        break;
      }
      default: {  // another digit, which leaves the JSON well formed
        const std::size_t digit = text.find_first_of("0123456789", at);
        if (digit != std::string::npos) text[digit] = static_cast<char>('0' + below(10));
      }
    }
  }

  std::vector<std::string> good_ = specs_below("/tests/study/corpus/good");
  std::vector<std::string> all_ = specs_below("/tests/study/corpus");
  std::mt19937_64 random_{20260729};  // a fixed seed: the standard fixes this generator's numbers
};

TEST(SpecFuzz, EveryTextGivesAStudyThatComesBackOrErrorsThatSaySomething) {
  Mutator mutator;
  int studies = 0;
  int refusals = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = mutator.mutated();
    SCOPED_TRACE(text);
    try {
      const Study study = decode_study(text, {});
      ++studies;
      ASSERT_EQ(decode_study(canonical_spec(study), {}), study);
      const Plan plan(study);
      ASSERT_GE(plan.trials(), 1U);
      (void)plan.parameters(plan.trials() - 1);
    } catch (const BadSpec& bad) {
      ++refusals;
      ASSERT_FALSE(bad.errors().empty());
      for (const SpecError& error : bad.errors()) ASSERT_FALSE(error.detail.empty());
    }
  }
  // Both sides were reached, or the test has told nothing.
  EXPECT_GT(studies, 2000);
  EXPECT_GT(refusals, 2000);
}

}  // namespace
}  // namespace steerstat
