#include "service/opened_studies.hpp"

#include <utility>

namespace steerstat {
namespace {

std::uint64_t bytes_of(const KeptStudy& study) {
  const StudyResult& result = study.result;
  return sizeof(KeptStudy) + result.trials.index.size() * (sizeof(std::uint64_t) + sizeof(TrialOutcome)) +
         result.audit.trials.size() * sizeof(AuditedTrial);
}

}  // namespace

std::shared_ptr<const KeptStudy> OpenedStudies::open(const std::string& id, std::uint64_t revision,
                                                     const std::function<KeptStudy()>& read) {
  if (auto found = find(id, revision)) return found;
  const std::lock_guard reading(reading_);
  if (auto found = find(id, revision)) return found;  // read while this one waited
  auto study = std::make_shared<const KeptStudy>(read());
  remember({id, revision, bytes_of(*study), study});
  return study;
}

void OpenedStudies::forget(const std::string& id) {
  const std::lock_guard lock(mutex_);
  opened_.remove_if([&](const Opened& one) { return one.id == id; });
}

std::shared_ptr<const KeptStudy> OpenedStudies::find(const std::string& id, std::uint64_t revision) {
  const std::lock_guard lock(mutex_);
  for (auto one = opened_.begin(); one != opened_.end(); ++one) {
    if (one->id != id || one->revision != revision) continue;
    opened_.splice(opened_.begin(), opened_, one);
    return one->study;
  }
  return nullptr;
}

void OpenedStudies::remember(Opened opened) {
  const std::lock_guard lock(mutex_);
  opened_.remove_if([&](const Opened& one) { return one.id == opened.id; });
  opened_.push_front(std::move(opened));
  std::uint64_t total = 0;
  for (auto one = opened_.begin(); one != opened_.end();) {
    total += one->bytes;
    one = total > most_ && one != opened_.begin() ? opened_.erase(one) : std::next(one);
  }
}

}  // namespace steerstat
