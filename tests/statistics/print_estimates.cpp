// Reads cases from standard input, one a line, and prints an interval for each: `low high`, a bound that does not exist
// as nan.
//
//   wilson SUCCESSES TRIALS LEVEL
//   clopper_pearson SUCCESSES TRIALS LEVEL
//   confidence_sequence SUCCESSES TRIALS LEVEL
//   quantile P LEVEL X...                    of a sample in ascending order
//   ranks N P LEVEL                          of a quantile's confidence sequence
//   ratio SUCCESSES TRIALS P                 log_mixture_ratio, twice
//   mean MEAN STD N LEVEL
//   mcnemar A_ONLY B_ONLY                    prints `p_value mid_p_value`
//   tango A_ONLY B_ONLY PAIRS LEVEL
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "statistics/confidence_sequence.hpp"
#include "statistics/paired.hpp"
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
  const auto& methods = proportion_method_names;
  const auto method = std::find(methods.begin(), methods.end(), kind);
  if (method != methods.end()) {
    std::uint64_t successes = 0;
    std::uint64_t trials = 0;
    double level = 0.0;
    words >> successes >> trials >> level;
    const auto which = static_cast<ProportionMethod>(method - methods.begin());
    const ProportionInterval found = proportion_interval(which, successes, trials, level);
    print({found.low, found.high});
  } else if (kind == "quantile") {
    double p = 0.0;
    double level = 0.0;
    words >> p >> level;
    std::vector<double> sorted;
    for (double x = 0.0; words >> x;) sorted.push_back(x);
    print(quantile_interval(sorted, p, level));
  } else if (kind == "ranks") {
    std::uint64_t n = 0;
    double p = 0.0;
    double level = 0.0;
    words >> n >> p >> level;
    const QuantileRanks ranks = confidence_sequence_ranks(n, p, level);
    SampleInterval interval;
    if (ranks.low) interval.low = static_cast<double>(*ranks.low);
    if (ranks.high) interval.high = static_cast<double>(*ranks.high);
    print(interval);
  } else if (kind == "ratio") {
    std::uint64_t successes = 0;
    std::uint64_t trials = 0;
    double p = 0.0;
    words >> successes >> trials >> p;
    const double ratio = log_mixture_ratio(successes, trials, p);
    print({ratio, ratio});
  } else if (kind == "mean") {
    double mean = 0.0;
    double std = 0.0;
    std::uint64_t n = 0;
    double level = 0.0;
    words >> mean >> std >> n >> level;
    print(mean_interval(mean, std, n, level));
  } else if (kind == "mcnemar") {
    PairedCounts counts;
    words >> counts.a_only >> counts.b_only;
    const McNemarTest test = mcnemar_test(counts);
    print({test.p_value, test.mid_p_value});
  } else if (kind == "tango") {
    PairedCounts counts;
    std::uint64_t pairs = 0;
    double level = 0.0;
    words >> counts.a_only >> counts.b_only >> pairs >> level;
    counts.neither = pairs - counts.a_only - counts.b_only;
    const DifferenceInterval found = tango_interval(counts, level);
    print({found.low, found.high});
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
