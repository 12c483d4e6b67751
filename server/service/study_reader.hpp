#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/comparison.hpp"
#include "service/catalogue.hpp"
#include "service/intact_files.hpp"
#include "service/opened_studies.hpp"
#include "service/study_rows.hpp"
#include "service/study_views.hpp"

namespace steerstat {

struct SummaryText;

/// Answers what the finished trials of studies say, running ones too. Thread-safe. Throws RunFailure where files cannot
/// be read.
class StudyReader {
 public:
  /// @param catalogue  must outlive this
  StudyReader(const Catalogue& catalogue, const ServiceLimits& limits)
      : catalogue_(catalogue), replaying_time_(limits.replaying_time), opened_(limits.opened_results) {}

  [[nodiscard]] SummaryText summary(const StudyEntry& entry);
  [[nodiscard]] TrialPage trials(const StudyEntry& entry, const TrialFilter& filter, std::uint64_t begin,
                                 std::size_t limit);
  [[nodiscard]] TrialPage trial(const StudyEntry& entry, std::uint64_t index);
  /// @throws TakesTooLong
  [[nodiscard]] ReplayedTrial trajectory(const StudyEntry& entry, std::uint64_t index);
  [[nodiscard]] std::optional<std::filesystem::path> result_file(const StudyEntry& entry);
  [[nodiscard]] Comparison compare(const StudyEntry& a, const StudyEntry& b);

  // Documents of schemas/view.schema.json.
  [[nodiscard]] StudyViews::Text study_view(const StudyEntry& entry);
  [[nodiscard]] std::string success_map(const StudyEntry& entry, std::string_view x, std::string_view y);
  [[nodiscard]] std::string trial_view(const StudyEntry& entry, std::uint64_t index);
  [[nodiscard]] std::string comparison_view(const StudyEntry& a, const StudyEntry& b);

  void forget(const std::string& id) {
    opened_.forget(id);
    views_.forget(id);
  }

 private:
  /// Finished trials as they lie somewhere in memory.
  struct View {
    std::span<const TrialOutcome> outcomes;
    std::span<const std::uint64_t> index;  ///< of each; empty where it is the position
    const KeptStudy* kept;                 ///< what they belong to; null in a run under way
  };
  using Look = std::function<void(const View&)>;

  void look_at(const StudyEntry& entry, const Look& look);
  [[nodiscard]] std::optional<TrialPage> stored_page(const StudyEntry& entry, const Plan& plan,
                                                     const TrialFilter& filter, std::uint64_t begin, std::size_t limit);
  /// (varying x rows) of the inputs that vary.
  using Parameters = std::vector<std::vector<double>>;

  /// @param parameters  those of the trials, where they are read from the disk with them now; or null
  [[nodiscard]] std::shared_ptr<const KeptStudy> opened(const StudyEntry& entry, Parameters* parameters = nullptr);
  [[nodiscard]] std::shared_ptr<const KeptStudy> everything(const StudyEntry& entry, Parameters* parameters = nullptr);
  /// All finished trials and their parameters, from the disk where both are read now, or else drawn anew.
  [[nodiscard]] std::shared_ptr<const KeptStudy> everything_drawn(const StudyEntry& entry, Parameters& parameters);
  [[nodiscard]] std::optional<std::string> kept_summary(const StudyEntry& entry) const;
  /// @throws RunFailure where a trial computed again did not end as it is kept
  static void require_same_end(const StudyEntry& entry, std::uint64_t index, const TrialOutcome& now,
                               const TrialOutcome& then);

  const Catalogue& catalogue_;
  const std::chrono::milliseconds replaying_time_;
  OpenedStudies opened_;
  IntactFiles intact_{};
  StudyViews views_{};
  std::mutex comparing_{};  // one at a time: each holds two studies and their parameters
};

}  // namespace steerstat
