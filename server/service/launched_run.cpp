#include "service/launched_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stop_token>
#include <string>
#include <thread>

#include "core/errors.hpp"
#include "service/recent_rate.hpp"
#include "store/whole_file.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// What the launched program ended with that is no failure: gates do not make one of a study that is kept.
bool is_done(int code) {
  return code == 0 || code == 1 || code == 3;
}
constexpr int interrupted = 130;

/// The end of what it said.
std::string last_words(const fs::path& log) {
  constexpr std::size_t most = 500;
  std::ostringstream said;
  said << std::ifstream(log).rdbuf();
  std::string text = std::move(said).str();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (text.size() > most) text.erase(0, text.size() - most);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "it said nothing" : text;
}

class LaunchedRun {
 public:
  LaunchedRun(const KeptRun& run, const Launcher& launcher, StudyDirectory& directory)
      : run_(run), launcher_(launcher), directory_(directory), home_(run.entry.home) {}

  bool run_to_end() {
    LaunchedProcess process = found_or_launched();
    note_earlier();
    follow(process);
    const std::stop_token stop = stop_token();
    if (const auto code = process.exit_code();
        code && !is_done(*code) && *code != interrupted && !stop.stop_requested()) {
      throw RunFailure(
          fmt::format("`{}` ended with exit code {} ({})", launcher_.text(), *code, last_words(home_.launched_log())));
    }
    const bool is_whole = take_result();
    if (!is_whole && !stop.stop_requested()) {
      throw RunFailure(fmt::format("`{}` has ended and left the study unfinished ({})", launcher_.text(),
                                   last_words(home_.launched_log())));
    }
    return is_whole;
  }

 private:
  [[nodiscard]] std::stop_token stop_token() const {
    return run_.catalogue.look(run_.entry, [](const StudyEntry& entry) { return entry.run->stop.get_token(); });
  }

  LaunchedProcess found_or_launched() {
    if (auto found = LaunchedProcess::find(home_.launched_note())) {
      run_.tell(fmt::format("study {} is still run by what was launched for it before", run_.entry.id));
      return *found;
    }
    home_.hand_to_launched(directory_, *run_.entry.study, run_.tell);
    const std::string spec = canonical_spec(*run_.entry.study);
    write_whole_file(home_.launched_spec(), {std::as_bytes(std::span(spec))});
    std::vector<std::string> command = launcher_.prefix;
    const auto absolute = [](const fs::path& path) { return fs::absolute(path).string(); };
    for (const std::string& word :
         {launcher_.program, std::string("run"), absolute(home_.launched_spec()), std::string("-o"),
          absolute(home_.launched_result()), std::string("--resume"), std::string("--no-progress")}) {
      command.push_back(word);
    }
    return LaunchedProcess::launch(command, absolute(home_.launched_note()), absolute(home_.launched_log()));
  }

  void follow(LaunchedProcess& process) {
    constexpr std::chrono::milliseconds interval{100};
    const std::stop_token stop = stop_token();
    bool is_told = false;
    while (!process.has_ended()) {
      if (stop.stop_requested() && !is_told) {
        process.send(SIGTERM);
        is_told = true;
      }
      note_progress();
      std::this_thread::sleep_for(interval);
    }
    note_progress();
  }

  /// What it goes on from, which is no progress of this run.
  void note_earlier() {
    in_shards_before_ = home_.launched_trials();
    completed_before_ = show_trials();
    completed_ = completed_before_;
    rate_.add(RecentRate::Clock::now(), completed_);
    run_.catalogue.change(run_.entry, [&](StudyEntry& entry) { entry.record.completed = completed_; });
  }

  void note_progress() {
    const std::uint64_t in_shards = std::max(home_.launched_trials(), in_shards_before_);
    const std::uint64_t completed =
        std::min(completed_before_ + in_shards - in_shards_before_, run_.entry.demand.trials);
    if (completed <= completed_) return;
    run_.trials_done += completed - completed_;
    completed_ = completed;
    const std::optional<double> per_second = rate_.add(RecentRate::Clock::now(), completed);
    if (Clock::now() >= next_reading_) show_trials();
    run_.catalogue.change(run_.entry, [&](StudyEntry& entry) {
      entry.record.completed = completed;
      entry.run->trials_per_s = per_second;
    });
  }

  /// Lets readers see what has come. That takes reading it; what is due again is put off, to be a twentieth of the
  /// time.
  /// @return how many trials there are
  std::uint64_t show_trials() {
    const Clock::time_point begin = Clock::now();
    const auto kept = std::make_shared<const KeptStudy>(home_.read(*run_.entry.study, run_.entry.origin));
    run_.catalogue.change(run_.entry, [&](StudyEntry& entry) { entry.run->result = kept; });
    next_reading_ = Clock::now() + 20 * (Clock::now() - begin);
    return kept->result.finished();
  }

  /// Puts the result in its place. @return whether there is a whole one
  bool take_result() {
    std::error_code error;
    if (!fs::exists(home_.launched_result(), error)) return false;
    const StoredStudy stored = read_result(home_.launched_result());
    if (!stored.result.complete || spec_sha256(stored.study) != spec_sha256(*run_.entry.study)) return false;
    fs::rename(home_.launched_result(), home_.result(), error);
    if (error) {
      throw RunFailure(fmt::format("cannot rename {} ({})", home_.launched_result().string(), error.message()));
    }
    sync_directory(home_.path());
    return true;
  }

  const KeptRun& run_;
  const Launcher& launcher_;
  StudyDirectory& directory_;
  const StudyHome& home_;
  std::uint64_t completed_before_{0};  // trials, when this began to follow it
  std::uint64_t in_shards_before_{0};  // of them
  std::uint64_t completed_{0};
  RecentRate rate_{};
  Clock::time_point next_reading_{};
};

}  // namespace

bool run_launched(const KeptRun& run, const Launcher& launcher, StudyDirectory& directory) {
  return LaunchedRun(run, launcher, directory).run_to_end();
}

}  // namespace steerstat
