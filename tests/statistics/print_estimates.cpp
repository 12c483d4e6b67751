// Reads cases from standard input, one a line, and prints an interval for each: `low high`, a bound that does not exist
// as nan.
//
//   wilson SUCCESSES TRIALS LEVEL
//   clopper_pearson SUCCESSES TRIALS LEVEL
//   quantile P LEVEL X...                    of a sample in ascending order
//   mean MEAN STD N LEVEL
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "statistics/proportion.hpp"
#include "statistics/sample_interval.hpp"

namespace {

using namespace steerstat;

void print(const SampleInterval& interval) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::printf("%.17g %.17g\n", interval.low.value_or(none), interval.high.value_or(none));
}

/// @return whether the case is one we know
bool answer(std::istringstream& words) {
  std::string kind;
  words >> kind;
  if (kind == "wilson" || kind == "clopper_pearson") {
    std::uint64_t successes = 0;
    std::uint64_t trials = 0;
    double level = 0.0;
    words >> successes >> trials >> level;
    const auto interval = kind == "wilson" ? wilson_interval : clopper_pearson_interval;
    const ProportionInterval found = interval(successes, trials, level);
    print({found.low, found.high});
  } else if (kind == "quantile") {
    double p = 0.0;
    double level = 0.0;
    words >> p >> level;
    std::vector<double> sorted;
    for (double x = 0.0; words >> x;) sorted.push_back(x);
    print(quantile_interval(sorted, p, level));
  } else if (kind == "mean") {
    double mean = 0.0;
    double std = 0.0;
    std::uint64_t n = 0;
    double level = 0.0;
    words >> mean >> std >> n >> level;
    print(mean_interval(mean, std, n, level));
  } else {
    return false;
  }
  return true;
}

}  // namespace

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    if (!answer(words)) {
      std::cerr << "unknown case: " << line << '\n';
      return 1;
    }
  }
}
