#include "service/study_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "service/admitted_study.hpp"
#include "service/catalogue.hpp"
#include "service/data_directory.hpp"
#include "service/kept_run.hpp"
#include "service/study_reader.hpp"
#include "service/study_runner.hpp"
#include "store/free_space.hpp"
#include "study/continuation.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using Tell = std::function<void(const std::string&)>;

/// One line at a time.
Tell in_turn(Tell tell) {
  return [tell = std::move(tell), mutex = std::make_shared<std::mutex>()](const std::string& line) {
    const std::lock_guard lock(*mutex);
    if (tell) tell(line);
  };
}

}  // namespace

class StudyService::Implementation {
 public:
  Implementation(const std::filesystem::path& data, unsigned threads, const ServiceLimits& limits, Tell tell,
                 std::optional<Launcher> launcher)
      : limits_(limits),
        tell_(in_turn(std::move(tell))),
        data_(data),
        reader_(catalogue_, limits),
        runner_(catalogue_, threads > 0 ? threads : default_threads(), limits, tell_, std::move(launcher)) {
    std::vector<Catalogue::Entry> unfinished;
    for (const Catalogue::Entry& entry : data_.recover(tell_)) {
      catalogue_.insert(entry);
      if (!is_over(entry->record.status)) unfinished.push_back(entry);
    }
    std::sort(unfinished.begin(), unfinished.end(), [](const Catalogue::Entry& a, const Catalogue::Entry& b) {
      return std::pair(a->record.created, a->id) < std::pair(b->record.created, b->id);
    });
    for (const Catalogue::Entry& entry : unfinished) {
      tell_(fmt::format("study {} was not over when the service ended: it goes on", entry->id));
      runner_.enqueue(entry);
    }
    runner_.start();
  }

  ~Implementation() { stop(); }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  void stop() {
    stopping_ = true;
    catalogue_.close();
    runner_.stop();
  }

  Submission submit(std::string_view text) {
    const auto study = std::make_shared<const Study>(admitted_study(text, limits_, runner_.memory()));
    const std::string id = study_id(*study);
    wait_while_cancelled(id);
    const std::lock_guard lock(changing_);
    require_going();
    if (const Catalogue::Entry known = catalogue_.find(id)) {
      go_on(known);
      return {catalogue_.state(*known), false};
    }
    require_place();
    return {catalogue_.state(*add(study)), true};
  }

  Removal cancel_or_remove(const std::string& id) {
    Catalogue::Entry entry;
    {
      const std::lock_guard lock(changing_);
      require_going();
      entry = known(id);
      const StudyState state = catalogue_.state(*entry);
      if (is_over(state.status)) {
        entry->home.remove();
        catalogue_.erase(*entry);
        reader_.forget(id);
        return {state, true};
      }
      if (!cancel(*entry)) return {catalogue_.state(*entry), false};
    }
    const StudyState state = catalogue_.wait_for_end(*entry, limits_.cancelling_time);
    if (!is_over(state.status)) keep_record(catalogue_, *entry);
    return {state, false};
  }

  [[nodiscard]] Catalogue::Entry known(const std::string& id) const {
    Catalogue::Entry entry = catalogue_.find(id);
    if (!entry) throw NoSuchStudy(id);
    return entry;
  }

  [[nodiscard]] const Catalogue& catalogue() const { return catalogue_; }
  [[nodiscard]] StudyReader& reader() { return reader_; }
  [[nodiscard]] const StudyRunner& runner() const { return runner_; }
  [[nodiscard]] const ServiceLimits& limits() const { return limits_; }

 private:
  void require_going() const {
    if (stopping_) throw QueueFull("the service is being stopped; try again when it is back", 10);
  }

  void require_place() const {
    if (runner_.queued() < limits_.queued_studies) return;
    throw QueueFull(fmt::format("{} studies wait already, as many as may; try again later", runner_.queued()), 30);
  }

  Catalogue::Entry add(const std::shared_ptr<const Study>& study) {
    const StudyDemand demand = demand_of(*study);
    require_free_space(data_.studies(), demand.disk + limits_.disk_headroom);
    const ShardOrigin origin = origin_of(*study);
    const Catalogue::Entry earlier =
        catalogue_.find_related(origin, [&](const StudyEntry& entry) { return continues(*study, *entry.study); });
    StudyRecord record;
    record.created = utc_now();
    record.revision = next_revision(0);
    if (earlier) record.completed = std::min(catalogue_.state(*earlier).completed, demand.trials);
    const StudyHome home = data_.home_of(study_id(*study));
    home.create(*study, record, earlier ? &earlier->home : nullptr);
    auto entry = std::make_shared<StudyEntry>(study_id(*study), study, home, origin, std::move(record));
    catalogue_.insert(entry);
    runner_.enqueue(entry);
    return entry;
  }

  /// Lets a study that was cancelled or has failed run again.
  void go_on(const Catalogue::Entry& entry) {
    if (is_being_cancelled(*entry)) {
      throw QueueFull("the study is being cancelled, and its blocks in flight take long; try again later", 10);
    }
    const StudyStatus status = catalogue_.state(*entry).status;
    if (status != StudyStatus::cancelled && status != StudyStatus::failed) return;
    require_place();
    {
      const std::lock_guard partial(entry->partial.mutex);
      entry->home.forget_partial_result();
    }
    set_status(*entry, StudyStatus::queued, std::nullopt);
    runner_.enqueue(entry);
  }

  /// Cancels a study that waits, on the disk too, or one that runs. @return whether its run is still to end
  bool cancel(StudyEntry& entry) {
    if (runner_.withdraw(entry)) {
      set_status(entry, StudyStatus::cancelled, utc_now());
      return false;
    }
    return catalogue_.change(entry, [this](StudyEntry& now) {
      if (!now.run) return false;
      if (!now.run->is_cancelled) now.run->given_up_at = StudyEntry::Clock::now() + limits_.ending_time;
      now.run->is_cancelled = true;
      now.run->stop.request_stop();
      return true;
    });
  }

  [[nodiscard]] bool is_being_cancelled(const StudyEntry& entry) const {
    return catalogue_.look(entry, [](const StudyEntry& now) { return now.run && now.run->is_cancelled; });
  }

  /// Whoever submits a study that is being cancelled waits for its end, and only they.
  void wait_while_cancelled(const std::string& id) const {
    const Catalogue::Entry entry = catalogue_.find(id);
    if (entry && is_being_cancelled(*entry)) catalogue_.wait_for_end(*entry, limits_.cancelling_time);
  }

  void set_status(StudyEntry& entry, StudyStatus status, const std::optional<std::string>& finished) {
    catalogue_.change(entry, [&](StudyEntry& now) {
      now.record.status = status;
      now.record.finished = finished;
      now.record.failure.reset();
    });
    keep_record(catalogue_, entry);
  }

  const ServiceLimits limits_;
  const Tell tell_;
  const DataDirectory data_;
  Catalogue catalogue_{};
  StudyReader reader_;
  StudyRunner runner_;
  std::mutex changing_{};  // held by who adds, cancels or removes a study
  std::atomic<bool> stopping_{false};
};

StudyService::StudyService(const std::filesystem::path& data, unsigned threads, const ServiceLimits& limits,
                           std::function<void(const std::string&)> tell, std::optional<Launcher> launcher)
    : implementation_(std::make_unique<Implementation>(data, threads, limits, std::move(tell), std::move(launcher))) {}

StudyService::~StudyService() = default;

void StudyService::stop() {
  implementation_->stop();
}

Submission StudyService::submit(std::string_view spec) {
  return implementation_->submit(spec);
}

StudyPage StudyService::list(std::size_t limit, std::string_view cursor) const {
  Catalogue::Page page = implementation_->catalogue().page(limit, cursor);
  return {std::move(page.states), std::move(page.next)};
}

std::optional<StudyState> StudyService::state(const std::string& id) const {
  const Catalogue::Entry entry = implementation_->catalogue().find(id);
  if (!entry) return std::nullopt;
  return implementation_->catalogue().state(*entry);
}

std::optional<StudyState> StudyService::wait_for_change(const std::string& id, std::uint64_t revision,
                                                        std::chrono::milliseconds timeout,
                                                        const std::stop_token& stop) const {
  return implementation_->catalogue().wait(id, revision, timeout, stop);
}

SummaryText StudyService::summary(const std::string& id) const {
  return implementation_->reader().summary(*implementation_->known(id));
}

std::string StudyService::spec(const std::string& id) const {
  return canonical_spec(*implementation_->known(id)->study);
}

std::shared_ptr<const Study> StudyService::study(const std::string& id) const {
  return implementation_->known(id)->study;
}

TrialPage StudyService::trials(const std::string& id, const TrialFilter& filter, std::uint64_t begin,
                               std::size_t limit) const {
  return implementation_->reader().trials(*implementation_->known(id), filter, begin, limit);
}

TrialPage StudyService::trial(const std::string& id, std::uint64_t index) const {
  return implementation_->reader().trial(*implementation_->known(id), index);
}

ReplayedTrial StudyService::trajectory(const std::string& id, std::uint64_t index) const {
  return implementation_->reader().trajectory(*implementation_->known(id), index);
}

std::optional<std::filesystem::path> StudyService::result_file(const std::string& id) const {
  return implementation_->reader().result_file(*implementation_->known(id));
}

StudyService::Removal StudyService::cancel_or_remove(const std::string& id) {
  return implementation_->cancel_or_remove(id);
}

Comparison StudyService::compare(const std::string& a, const std::string& b) const {
  return implementation_->reader().compare(*implementation_->known(a), *implementation_->known(b));
}

std::shared_ptr<const std::string> StudyService::study_view(const std::string& id) const {
  return implementation_->reader().study_view(*implementation_->known(id));
}

std::string StudyService::success_map(const std::string& id, std::string_view x, std::string_view y) const {
  return implementation_->reader().success_map(*implementation_->known(id), x, y);
}

std::string StudyService::trial_view(const std::string& id, std::uint64_t index) const {
  return implementation_->reader().trial_view(*implementation_->known(id), index);
}

std::string StudyService::comparison_view(const std::string& a, const std::string& b) const {
  return implementation_->reader().comparison_view(*implementation_->known(a), *implementation_->known(b));
}

ServiceCounters StudyService::counters() const {
  ServiceCounters counters = implementation_->catalogue().counters();
  counters.trials_done = implementation_->runner().trials_done();
  counters.threads = implementation_->runner().threads();
  return counters;
}

const ServiceLimits& StudyService::limits() const {
  return implementation_->limits();
}

}  // namespace steerstat
