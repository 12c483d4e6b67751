#include "store/result_rows.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"
#include "store/column.hpp"
#include "store/layout.hpp"
#include "store/memory_file.hpp"
#include "store/trial_columns.hpp"

namespace steerstat {
namespace {

using hdf5::Problem;

/// Trials that are read together lie in so many rows at most: as many as HDF5 has to read for one of them anyway.
constexpr std::uint64_t most_rows = 65536;

/// Calls use(group) with the file's /trials.
template <class Use>
auto with_trials(const std::filesystem::path& path, const Use& use) {
  try {
    const hdf5::Session session;
    const hdf5::Handle file = hdf5::open_on_disk(path);
    const hdf5::Handle trials = hdf5::open_group(file.id(), "trials");
    return use(trials.id());
  } catch (const Problem& problem) {
    throw RunFailure(fmt::format("cannot read {}: {}", path.string(), problem.what()));
  }
}

std::size_t rows_of(hid_t trials) {
  return hdf5::Column(trials, "index", hdf5::type_of(std::uint64_t{}), "1").rows();
}

}  // namespace

std::vector<Status> ResultRows::statuses() const {
  return with_trials(path_, [](hid_t trials) {
    const std::size_t rows = rows_of(trials);
    return hdf5::read_statuses(trials, "/trials", {0, rows, rows});
  });
}

std::vector<TrialOutcome> ResultRows::outcomes(std::span<const std::uint64_t> index) const {
  return with_trials(path_, [&](hid_t trials) {
    const std::size_t rows = rows_of(trials);
    if (!index.empty() && index.back() >= rows) throw Problem(fmt::format("it has no trial {}", index.back()));
    std::vector<TrialOutcome> outcomes;
    outcomes.reserve(index.size());
    while (outcomes.size() < index.size()) {
      const auto wanted = index.subspan(outcomes.size());
      const std::uint64_t begin = wanted.front();
      const auto end = std::find_if(wanted.begin(), wanted.end(),
                                    [&](std::uint64_t one) { return one / most_rows != begin / most_rows; });
      const auto together = wanted.first(static_cast<std::size_t>(end - wanted.begin()));
      const auto read = hdf5::read_outcomes(trials, {begin, together.back() + 1 - begin, rows});
      for (const std::uint64_t one : together) outcomes.push_back(read[one - begin]);
    }
    return outcomes;
  });
}

}  // namespace steerstat
