#include "service/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "service/study_service.hpp"
#include "store/result_rows.hpp"
#include "study/plan.hpp"

namespace steerstat {
namespace {

/// The trials that pass, up to `limit`, from index `begin` on. Without the values of what varies.
template <class View>
TrialPage page_of(const View& view, const Plan& plan, const TrialFilter& filter, std::uint64_t begin,
                  std::size_t limit) {
  TrialPage page;
  const auto index_of = [&](std::size_t row) { return view.index.empty() ? row : view.index[row]; };
  std::size_t row = view.index.empty()
                        ? std::min<std::size_t>(begin, view.outcomes.size())
                        : static_cast<std::size_t>(std::lower_bound(view.index.begin(), view.index.end(), begin) -
                                                   view.index.begin());
  for (; row < view.outcomes.size(); ++row) {
    const std::uint64_t index = index_of(row);
    const TrialOutcome& outcome = view.outcomes[row];
    if (filter.status && outcome.status != *filter.status) continue;
    if (filter.cell && plan.cell_of(index) != *filter.cell) continue;
    if (page.rows.size() == limit) {
      page.next = index;
      break;
    }
    page.rows.push_back({index, plan.cell_of(index), {}, outcome});
  }
  return page;
}

/// Which trials of a complete result pass: up to one more than `limit`, from index `begin` on.
std::vector<std::uint64_t> passing(const ResultRows& result, std::uint64_t trials, const Plan& plan,
                                   const TrialFilter& filter, std::uint64_t begin, std::size_t limit) {
  const std::vector<Status> statuses = filter.status ? result.statuses() : std::vector<Status>{};
  std::vector<std::uint64_t> index;
  for (std::uint64_t i = begin; i < trials && index.size() <= limit; ++i) {
    if (filter.status && statuses.at(i) != *filter.status) continue;
    if (filter.cell && plan.cell_of(i) != *filter.cell) continue;
    index.push_back(i);
  }
  return index;
}

std::vector<double> values_of(const Plan& plan, std::uint64_t index) {
  std::vector<double> values(plan.varying().size());
  plan.draw(index, values);
  return values;
}

/// (varying x rows) as a result file has them.
std::vector<std::vector<double>> parameters_of(const Plan& plan, std::span<const std::uint64_t> index) {
  std::vector<std::vector<double>> columns(plan.varying().size(), std::vector<double>(index.size()));
  std::vector<double> values(plan.varying().size());
  for (std::size_t row = 0; row < index.size(); ++row) {
    plan.draw(index[row], values);
    for (std::size_t i = 0; i < values.size(); ++i) columns[i][row] = values[i];
  }
  return columns;
}

}  // namespace

std::shared_ptr<const KeptStudy> StudyReader::opened(const StudyEntry& entry, Parameters* parameters) {
  const std::uint64_t revision = catalogue_.look(entry, [](const StudyEntry& now) { return now.record.revision; });
  return opened_.open(entry.id, revision, [&] { return entry.home.read(*entry.study, entry.origin, parameters); });
}

/// Looks at the finished trials, wherever they are at the moment.
void StudyReader::look_at(const StudyEntry& entry, const Look& look) {
  constexpr std::chrono::milliseconds pause{20};
  // A run that begins reads what is on the disk, and one that ends sorts its trials: neither takes long.
  for (int tries = 0; tries < 250; ++tries) {
    const std::optional<StudyEntry::Run> run = catalogue_.look(entry, [](const StudyEntry& now) { return now.run; });
    const std::shared_ptr<const KeptStudy> kept = run ? run->result : opened(entry);
    if (kept) {
      return look({kept->result.trials.outcomes, kept->result.trials.index, kept.get()});
    }
    const bool seen = run->live && run->live->read([&](std::span<const TrialOutcome> outcomes) {
      look({outcomes, {}, nullptr});
    });
    if (seen) return;
    std::this_thread::sleep_for(pause);
  }
  look({{}, {}, nullptr});
}

/// The page from the result on the disk, of which little is read; nothing where there is none, or it is in memory.
std::optional<TrialPage> StudyReader::stored_page(const StudyEntry& entry, const Plan& plan, const TrialFilter& filter,
                                                  std::uint64_t begin, std::size_t limit) {
  const StudyRecord record = catalogue_.look(entry, [](const StudyEntry& now) { return now.record; });
  if (record.status != StudyStatus::succeeded || opened_.find(entry.id, record.revision)) return std::nullopt;
  intact_.require(entry.home.result());
  const ResultRows result(entry.home.result());
  std::vector<std::uint64_t> index = passing(result, record.completed, plan, filter, begin, limit);
  TrialPage page;
  if (index.size() > limit) {
    page.next = index.back();
    index.pop_back();
  }
  const std::vector<TrialOutcome> outcomes = result.outcomes(index);
  for (std::size_t row = 0; row < index.size(); ++row) {
    page.rows.push_back({index[row], plan.cell_of(index[row]), {}, outcomes[row]});
  }
  return page;
}

/// The finished trials as a result. Those of a run under way are copied.
std::shared_ptr<const KeptStudy> StudyReader::everything(const StudyEntry& entry, Parameters* parameters) {
  const std::optional<StudyEntry::Run> run = catalogue_.look(entry, [](const StudyEntry& now) { return now.run; });
  if (!run) return opened(entry, parameters);
  if (run->result) return run->result;
  auto copy = std::make_shared<KeptStudy>();
  copy->engine_version = engine_version();
  StudyResult& result = copy->result;
  bool is_live = true;
  look_at(entry, [&](const View& view) {
    if (view.kept != nullptr) {  // it has ended meanwhile
      *copy = *view.kept;
      is_live = false;
      return;
    }
    result.trials.outcomes.assign(view.outcomes.begin(), view.outcomes.end());
  });
  if (!is_live) return copy;
  result.trials.index.resize(result.trials.outcomes.size());
  std::iota(result.trials.index.begin(), result.trials.index.end(), std::uint64_t{0});
  const std::chrono::duration<double> elapsed = StudyEntry::Clock::now() - run->began;
  result.wall_s = run->earlier_wall_s + elapsed.count();
  result.threads = run->threads;
  if (entry.study->integrator.method == IntegratorChoice::Method::lockstep) result.simd = best_instruction_set();
  return copy;
}

TrialPage StudyReader::trials(const StudyEntry& entry, const TrialFilter& filter, std::uint64_t begin,
                              std::size_t limit) {
  const Plan plan(*entry.study);
  const std::uint64_t revision = catalogue_.state(entry).revision;
  TrialPage page;
  if (auto stored = stored_page(entry, plan, filter, begin, limit)) {
    page = *std::move(stored);
  } else {
    look_at(entry, [&](const View& view) { page = page_of(view, plan, filter, begin, limit); });
  }
  for (TrialRow& row : page.rows) row.values = values_of(plan, row.index);
  page.names = plan.varying();
  page.revision = revision;
  return page;
}

TrialPage StudyReader::trial(const StudyEntry& entry, std::uint64_t index) {
  if (index >= entry.demand.trials) {
    throw NoSuchTrial(fmt::format("there is no trial {} in study {} (its trials are 0 to {})", index, entry.id,
                                  entry.demand.trials - 1));
  }
  TrialPage page = trials(entry, {}, index, 1);
  if (page.rows.empty() || page.rows.front().index != index) {
    throw NoSuchTrial(fmt::format("trial {} of study {} has not finished", index, entry.id));
  }
  page.next.reset();
  return page;
}

ReplayedTrial StudyReader::trajectory(const StudyEntry& entry, std::uint64_t index) {
  TrialPage page = trial(entry, index);
  TrialRow& row = page.rows.front();
  const Plan plan(*entry.study);
  Trajectory trajectory =
      replay(plan.parameters_with(index, row.values), entry.study->integrator, 0.05, 0, within(replaying_time_));
  require_same_end(entry, index, trajectory.outcome, row.outcome);
  return {std::move(page.names), std::move(row.values), std::move(trajectory)};
}

void StudyReader::require_same_end(const StudyEntry& entry, std::uint64_t index, const TrialOutcome& now,
                                   const TrialOutcome& then) {
  if (bears_out(now, then)) return;
  throw RunFailure(
      fmt::format("trial {} of study {} cannot be replayed: it ends {} at {} s, and is kept as {} at {} s (it was "
                  "computed by engine {}, this is {}); replay it with the build that computed it",
                  index, entry.id, name_of(now.status), now.end_time, name_of(then.status), then.end_time,
                  entry.origin.engine_version, engine_version()));
}

std::optional<std::filesystem::path> StudyReader::result_file(const StudyEntry& entry) {
  const std::lock_guard lock(entry.partial.mutex);
  const StudyState state = catalogue_.state(entry);
  if (!is_over(state.status)) return std::nullopt;
  if (std::filesystem::exists(entry.home.result())) return entry.home.result();
  const std::filesystem::path path = entry.home.partial_result();
  if (entry.partial.revision == state.revision && std::filesystem::exists(path)) return path;
  const std::shared_ptr<const KeptStudy> kept = opened(entry);
  if (kept->result.trials.index.empty()) return std::nullopt;
  write_result(path, *entry.study, kept->result);
  entry.partial.revision = state.revision;
  return path;
}

Comparison StudyReader::compare(const StudyEntry& a, const StudyEntry& b) {
  const std::lock_guard lock(comparing_);
  const std::array<std::shared_ptr<const KeptStudy>, 2> kept{everything(a), everything(b)};
  const auto parameters = [](const StudyEntry& entry, const KeptStudy& of) {
    return parameters_of(Plan(*entry.study), of.result.trials.index);
  };
  const auto parameters_a = parameters(a, *kept[0]);
  const auto parameters_b = parameters(b, *kept[1]);
  return steerstat::compare({*a.study, kept[0]->result, parameters_a, kept[0]->engine_version},
                            {*b.study, kept[1]->result, parameters_b, kept[1]->engine_version});
}

}  // namespace steerstat
