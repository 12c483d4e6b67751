#include "store/join_shares.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "store/result_file.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"
#include "study/watched.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

/// What is wrong with the shards; the first few of it, so that a thousand of them do not scroll the first ones away.
class Objections {
 public:
  void add(std::string objection) {
    if (shown_.size() < most_shown) shown_.push_back(std::move(objection));
    ++count_;
  }

  /// @throws BadUsage where there is any
  void raise() const {
    if (count_ == 0) return;
    std::string text = fmt::format("{}", fmt::join(shown_, "\n"));
    if (count_ > shown_.size()) text += fmt::format("\nand {} more like these", count_ - shown_.size());
    throw BadUsage(text);
  }

 private:
  static constexpr std::size_t most_shown = 10;
  std::vector<std::string> shown_;
  std::size_t count_{0};
};

/// "2, 5 to 7"
std::string numbers_text(const std::vector<std::uint64_t>& numbers) {
  std::vector<std::string> words;
  for (const TrialRange& range : ranges_of(numbers)) {
    const std::uint64_t last = range.end - 1;
    words.push_back(range.begin == last ? fmt::format("{}", last) : fmt::format("{} to {}", range.begin, last));
  }
  constexpr std::size_t most_words = 20;
  const std::size_t left = words.size() - std::min(words.size(), most_words);
  words.resize(words.size() - left);
  return fmt::format("{}{}", fmt::join(words, ", "), left > 0 ? fmt::format(" and {} more gaps", left) : "");
}

/// Takes shard after shard.
class Joining {
 public:
  void add(const fs::path& file) {
    StoredStudy stored = read_result(file);
    const std::string problem = first_ ? objection(stored, file) : unfitness(stored, file);
    if (!problem.empty()) return objections_.add(problem);
    if (!first_) begin(stored, file);
    take(std::move(stored.result), file);
  }

  /// @throws BadUsage
  JoinedShares end() {
    objections_.raise();
    std::sort(present_.begin(), present_.end(), [](TrialRange a, TrialRange b) { return a.begin < b.begin; });
    if (!is_sketched()) joined_.finished.trials = gathered(std::move(slots_), 0, present_);
    require_what_is_due();
    return std::move(joined_);
  }

 private:
  /// Why no merge can begin with this file; "" where one can.
  static std::string unfitness(const StoredStudy& stored, const fs::path& file) {
    if (!stored.result.share) {
      return fmt::format("{} is no shard of a study (shards are what `run --shard I/N` writes); leave it out",
                         file.string());
    }
    if (stored.engine_version != engine_version()) {
      return fmt::format(
          "{} is of engine version {} and this is {}, whose trials may differ in their bits; merge with {}",
          file.string(), stored.engine_version, engine_version(), stored.engine_version);
    }
    if (!stored.has_metrics) return fmt::format("{} is of a program that measured no metrics", file.string());
    return "";
  }

  /// Why this file does not go with those taken; "" where it does.
  [[nodiscard]] std::string objection(const StoredStudy& stored, const fs::path& file) const {
    if (std::string problem = unfitness(stored, file); !problem.empty()) return problem;
    if (spec_sha256(stored.study) != spec_) {
      return fmt::format("{} is of another study, id {}, than {}, id {} (all shards have the same spec)", file.string(),
                         study_id(stored.study), first_->string(), study_id(joined_.study));
    }
    const StudyShare share = *stored.result.share;
    if (share.count != files_.size()) {
      return fmt::format("{} is shard {} and {} is one of {} (all shards are of the same division)", file.string(),
                         share_text(share), first_->string(), files_.size());
    }
    if (const fs::path& same = files_[share.number - 1]; !same.empty()) {
      return fmt::format("{} and {} are both shard {}; name it once", same.string(), file.string(), share_text(share));
    }
    return "";
  }

  void begin(const StoredStudy& stored, const fs::path& file) {
    first_ = file;
    spec_ = spec_sha256(stored.study);
    joined_.study = stored.study;
    joined_.simd = stored.result.simd;
    files_.resize(stored.result.share->count);
    trials_ = Plan(joined_.study).trials();
    portion_ = portion_size(joined_.study);
    if (!is_sketched()) slots_.resize(trials_);
  }

  void take(StudyResult result, const fs::path& file) {
    const StudyShare share = *result.share;
    files_[share.number - 1] = file;
    FinishedTrials finished{std::move(result.trials), 0.0, std::move(result.sketch)};
    const std::vector<TrialRange> ranges = finished.ranges();
    present_.insert(present_.end(), ranges.begin(), ranges.end());
    if (is_sketched()) {
      joined_.finished = joined(std::move(joined_.finished), std::move(finished));
    } else {
      const TrialTable& trials = finished.trials;
      for (std::size_t row = 0; row < trials.index.size(); ++row) slots_[trials.index[row]] = trials.outcomes[row];
    }
    joined_.finished.wall_s += result.wall_s;
    joined_.threads = std::max(joined_.threads, result.threads);
    if (result.simd) joined_.simd = std::max(joined_.simd.value_or(*result.simd), *result.simd);  // best first
  }

  /// @throws BadUsage naming the shards that are missing or unfinished, where their trials are due
  void require_what_is_due() const {
    // A study that does not keep all rows and stops on precision does not run in shards.
    const std::uint64_t due = is_sketched() ? trials_ : trials_due(joined_.study, joined_.finished.trials);
    std::vector<std::uint64_t> missing;
    Objections objections;
    for (std::uint32_t number = 1; number <= files_.size(); ++number) {
      const StudyShare share{number, static_cast<std::uint32_t>(files_.size())};
      const TrialRange range = share_of(trials_, portion_, share);
      const std::uint64_t end = std::min(range.end, due);
      if (range.begin >= end) continue;
      const fs::path& file = files_[number - 1];
      if (file.empty()) {
        missing.push_back(number);
      } else if (rows_in({range.begin, end}) < end - range.begin) {
        objections.add(fmt::format("{} is unfinished, with {} of the {} trials of shard {}; run it again with --resume",
                                   file.string(), rows_in(range), range.end - range.begin, share_text(share)));
      }
    }
    if (!missing.empty()) {
      objections.add(fmt::format("of {} shards, {} {} missing: {}", files_.size(), missing.size(),
                                 missing.size() == 1 ? "is" : "are", numbers_text(missing)));
    }
    objections.raise();
  }

  /// How many trials of a range are there.
  [[nodiscard]] std::uint64_t rows_in(TrialRange range) const {
    auto next = std::lower_bound(present_.begin(), present_.end(), range.begin,
                                 [](TrialRange present, std::uint64_t begin) { return present.end <= begin; });
    std::uint64_t rows = 0;
    for (; next != present_.end() && next->begin < range.end; ++next) {
      rows += std::min(next->end, range.end) - std::max(next->begin, range.begin);
    }
    return rows;
  }

  [[nodiscard]] bool is_sketched() const { return joined_.study.store != Store::all; }

  Objections objections_;
  std::optional<fs::path> first_;    // the first that was taken
  std::string spec_;                 // its spec_sha256
  std::vector<fs::path> files_;      // (shards) by number, less 1; empty where none was taken
  std::vector<TrialRange> present_;  // trials taken
  std::vector<TrialOutcome> slots_;  // (trials) by index; empty where not all rows are kept
  std::uint64_t trials_{0};          // of the study
  std::uint64_t portion_{1};         // that shards are cut by
  JoinedShares joined_;
};

}  // namespace

JoinedShares join_shares(std::span<const fs::path> files) {
  Joining joining;
  for (const fs::path& file : files) joining.add(file);
  return joining.end();
}

}  // namespace steerstat
