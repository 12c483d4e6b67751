#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace steerstat {

/// Where a study of the service stands.
enum class StudyStatus : std::uint8_t { queued, running, succeeded, failed, cancelled };

/// As clients read them, by StudyStatus.
inline constexpr std::array<std::string_view, 5> study_status_names{"queued", "running", "succeeded", "failed",
                                                                    "cancelled"};

constexpr std::string_view name_of(StudyStatus status) {
  return study_status_names[static_cast<std::size_t>(status)];
}

/// Whether a study in this state stays in it until a client asks for something.
constexpr bool is_over(StudyStatus status) {
  return status != StudyStatus::queued && status != StudyStatus::running;
}

/// A study as a client may see it at one moment. A value.
struct StudyState {
  std::string id;  ///< study_id()
  std::string name;
  StudyStatus status{StudyStatus::queued};
  std::uint64_t completed{0};          ///< trials finished
  std::uint64_t requested{0};          ///< trials; the most there may be where the study stops on precision
  std::optional<double> trials_per_s;  ///< of the last seconds, while it runs
  std::optional<double> eta_s;         ///< [s] until it has all its trials at that rate; audits come on top
  std::string created;                 ///< UTC, ISO 8601 with milliseconds, as the two that follow
  std::optional<std::string> started;
  std::optional<std::string> finished;
  std::optional<std::string> failure;  ///< why it failed and what to do, in one line
  /// Grows with each change that a client could see, over restarts too: microseconds since 1970 at that change, or one
  /// more than before it.
  std::uint64_t revision{0};
};

}  // namespace steerstat
