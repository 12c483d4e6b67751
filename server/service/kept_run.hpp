#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "service/catalogue.hpp"
#include "service/launcher.hpp"
#include "service/service_limits.hpp"
#include "study/turnstile.hpp"

namespace steerstat {

/// What a study's run stands on.
struct KeptRun {
  Catalogue& catalogue;
  StudyEntry& entry;  ///< with a StudyEntry::Run
  unsigned threads;   ///< workers
  Turnstile& turns;
  const ServiceLimits& limits;
  const std::function<void(const std::string&)>& tell;
  std::atomic<std::uint64_t>& trials_done;  ///< gets the trials it finishes
  const std::optional<Launcher>& launcher;  ///< runs the study elsewhere; nothing: it runs in this process
};

/// Runs what is left of a study, keeps its trials, result and summary in its directory, and notes there and in its
/// entry how it ended. Throws nothing: a study that cannot go on has failed, with the reason in its record.
/// @return whether the record could be written; where not, keep_record() is to be tried again
bool run_and_keep(const KeptRun& run) noexcept;

/// Writes the record of a study as it is now. @throws RunFailure
void keep_record(const Catalogue& catalogue, StudyEntry& entry);

}  // namespace steerstat
