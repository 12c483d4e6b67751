#include "view/study_columns.hpp"

#include <algorithm>

namespace steerstat {
namespace {

// The finaliser of SplitMix64 [Steele et al. 2014]: a bijection of 64 bits, so that no two trials tie.
std::uint64_t scattered(std::uint64_t index) {
  std::uint64_t z = index + 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

}  // namespace

VaryingInput varying_input(const Study& study, const std::string& name) {
  const auto found = std::find_if(study.inputs.begin(), study.inputs.end(),
                                  [&](const Input& candidate) { return candidate.name == name; });
  const std::vector<std::string>& listed = study.sampling.explicit_names;
  return {&*found, std::find(listed.begin(), listed.end(), name) != listed.end()};
}

std::vector<double> values_of(std::span<const double> column, std::span<const std::size_t> rows) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const std::size_t row : rows) values.push_back(column[row]);
  return values;
}

std::vector<std::uint8_t> converged_among(const TrialTable& trials, std::span<const std::size_t> rows) {
  std::vector<std::uint8_t> converged;
  converged.reserve(rows.size());
  for (const std::size_t row : rows) converged.push_back(trials.outcomes[row].status == Status::converged ? 1 : 0);
  return converged;
}

std::vector<std::size_t> chosen_rows(const TrialTable& trials, std::span<const std::size_t> rows, std::size_t most) {
  if (rows.size() <= most) return {rows.begin(), rows.end()};
  if (most == 0) return {};
  std::vector<std::uint64_t> hashes;
  hashes.reserve(rows.size());
  for (const std::size_t row : rows) hashes.push_back(scattered(trials.index[row]));
  std::vector<std::uint64_t> sorted = hashes;
  const auto bound = sorted.begin() + static_cast<std::ptrdiff_t>(most) - 1;
  std::nth_element(sorted.begin(), bound, sorted.end());
  std::vector<std::size_t> chosen;
  chosen.reserve(most);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (hashes[i] <= *bound) chosen.push_back(rows[i]);
  }
  return chosen;
}

}  // namespace steerstat
