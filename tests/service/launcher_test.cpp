// Studies that the service runs through another program.

#include "service/launcher.hpp"

#include <csignal>
#include <fstream>
#include <sstream>
#include <utility>

#include "service_fixture.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

class LaunchedStudies : public ServiceCase {
 protected:
  LaunchedStudies() { service.reset(); }

  void begin_with(const Words& prefix) {
    service.reset();
    service = std::make_unique<StudyService>(
        data, 2, limits, [this](const std::string& line) { told.push_back(line); },
        Launcher{prefix, STEERSTAT_PROGRAM});
  }

  /// How a study ends for which a launcher does what it should not.
  StudyState failed_through(const Words& prefix) {
    begin_with(prefix);
    const StudyState state = wait_for_end(service->submit(quick_spec(100)).state.id);
    EXPECT_EQ(state.status, StudyStatus::failed);
    return state;
  }

  /// Goes on through a launcher whose programs say what they do into said_.
  void begin_telling(const Words& prefix = {}) {
    Words telling{"sh", "-c", R"(exec "$@" 2>>"$0")", said_};
    telling.insert(telling.end(), prefix.begin(), prefix.end());
    begin_with(telling);
  }
  [[nodiscard]] std::string said() const {
    std::ostringstream text;
    text << std::ifstream(said_).rdbuf();
    return std::move(text).str();
  }

  /// Submits a study and waits for its result, which is to be that of an undisturbed run. @return its id
  std::string expect_result(const std::string& spec) {
    const std::string id = service->submit(spec).state.id;
    const StudyState state = wait_for_end(id);
    EXPECT_EQ(state.status, StudyStatus::succeeded) << state.failure.value_or("");
    EXPECT_EQ(state.completed, state.requested);
    expect_undisturbed(id, spec);
    return id;
  }

  /// Runs a study, and one of half as many trials again, which is to run those alone.
  void expect_extension(const Words& prefix) {
    begin_telling(prefix);
    wait_for_end(service->submit(quick_spec(2000)).state.id);
    const std::string id = expect_result(quick_spec(3000));
    EXPECT_THAT(said(), HasSubstr("resuming after 2,000 of 3,000 trials"));
    EXPECT_THAT(files_called(id, "earlier-"), ::testing::IsEmpty());
    EXPECT_THAT(files_called(id, "launched"), ::testing::IsEmpty());
  }

  /// Begins a study of many quick trials and waits until some are finished, or all.
  std::string begun() {
    const std::string id = service->submit(quick_spec(many_trials)).state.id;
    wait_until(id, [](const StudyState& state) { return state.completed > 0 || is_over(state.status); });
    return id;
  }
  void cancel(const std::string& id) {
    if (!is_over(service->state(id)->status)) service->cancel_or_remove(id);
  }

  /// Runs a study that continues one which was begun, and expects that it does not run all of its trials.
  void expect_continuation(const std::string& spec) {
    expect_result(spec);
    const std::string text = said();
    const std::size_t resuming = text.rfind("resuming after");
    ASSERT_NE(resuming, std::string::npos) << text;
    EXPECT_THAT(text.substr(resuming), Not(::testing::StartsWith("resuming after 0 of")));
  }

  [[nodiscard]] std::vector<std::string> files_called(const std::string& id, const char* prefix) const {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(home(id))) {
      const std::string name = file.path().filename().string();
      if (name.starts_with(prefix)) names.push_back(name);
    }
    return names;
  }

  std::string said_ = (scratch.path() / "said").string();
};

TEST_F(LaunchedStudies, RunAsProgramsToTheSameBits) {
  begin_with({"env", "--"});
  const std::string id = expect_result(quick_spec(3000));
  EXPECT_THAT(files_called(id, "launched"), ::testing::IsEmpty());
  EXPECT_TRUE(service->summary(id).complete);
}

#ifdef MPIRUN_PROGRAM
const Words on_two_ranks{"env", "PATH=/usr/bin:/bin", MPIRUN_PROGRAM, "--allow-run-as-root", "--oversubscribe", "-n",
                         "2"};

TEST_F(LaunchedStudies, RunOnTheRanksOfAnMpiJob) {
  begin_with(on_two_ranks);
  expect_result(quick_spec(3000));
}

TEST_F(LaunchedStudies, OnRanksExtendAStudyWithoutRunningItsTrialsAgain) {
  expect_extension(on_two_ranks);
}
#endif

TEST_F(LaunchedStudies, ExtendAStudyWithoutRunningItsTrialsAgain) {
  expect_extension({});
}

TEST_F(LaunchedStudies, ExtendOneThatWasCancelled) {
  begin_telling();
  cancel(begun());
  expect_continuation(quick_spec(many_trials + 1000));
}

TEST_F(LaunchedStudies, ExtendOneThatWasKilled) {
  begin_telling();
  const std::string id = begun();
  if (auto process = LaunchedProcess::find(home(id) / "launched.process")) process->send(SIGKILL);
  wait_for_end(id);
  expect_continuation(quick_spec(many_trials + 1000));
}

TEST_F(LaunchedStudies, GoOnFromTrialsThatRanInTheServiceItself) {
  begin();
  cancel(begun());
  begin_telling();
  expect_continuation(quick_spec(many_trials + 1000));
}

TEST_F(LaunchedStudies, FailWithWhatTheLauncherSaid) {
  EXPECT_THAT(failed_through({"no-such-launcher"}).failure.value_or(""),
              AllOf(HasSubstr("`no-such-launcher` ended with exit code 127"), HasSubstr("not found")));
  EXPECT_THAT(failed_through({"sh", "-c", "echo no nodes left >&2; exit 9"}).failure.value_or(""),
              HasSubstr("ended with exit code 9 (no nodes left)"));
  EXPECT_THAT(failed_through({"true"}).failure.value_or(""), HasSubstr("left the study unfinished (it said nothing)"));
  // A launcher that works lets it go on.
  begin_with({"env"});
  const std::string id = service->submit(quick_spec(100)).state.id;
  EXPECT_EQ(wait_for_end(id).status, StudyStatus::succeeded);
}

TEST_F(LaunchedStudies, AreCancelledBySignalWithTheirTrialsKept) {
  begin_with({"env"});
  const std::string id = service->submit(long_spec()).state.id;
  wait_until(id, [](const StudyState& state) { return state.completed > 0; });
  wait_for_kept_trials(id);
  const auto process = LaunchedProcess::find(home(id) / "launched.process");
  EXPECT_TRUE(process);
  const auto removal = service->cancel_or_remove(id);
  EXPECT_EQ(removal.state.status, StudyStatus::cancelled);
  EXPECT_FALSE(LaunchedProcess::find(home(id) / "launched.process"));
  EXPECT_FALSE(service->trials(id, {}, 0, 1).rows.empty());
}

TEST_F(LaunchedStudies, ThatSurvivedARestartAreFollowedAndNotRunTwice) {
  const std::string spec = quick_spec(100);
  const std::string id = failed_through({"false"}).id;
  service.reset();
  const auto file = [&](const char* name) { return (home(id) / name).string(); };
  // As a service has left it that was killed: what it launched waits for a file, then runs.
  const Words command{"sh",
                      "-c",
                      "while ! [ -e \"$0\" ]; do sleep 0.05; done; exec \"$@\"",
                      file("go"),
                      STEERSTAT_PROGRAM,
                      "run",
                      file("launched.json"),
                      "-o",
                      file("launched.h5"),
                      "--resume",
                      "--no-progress"};
  LaunchedProcess process = LaunchedProcess::launch(command, file("launched.process"), file("launched.log"));
  while (!LaunchedProcess::find(file("launched.process"))) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  begin_with({"false"});
  EXPECT_EQ(service->submit(spec).state.id, id);
  wait_for(id, StudyStatus::running);
  std::ofstream(file("go")) << "go";
  const StudyState state = wait_for_end(id);
  EXPECT_EQ(state.status, StudyStatus::succeeded) << state.failure.value_or("");
  expect_undisturbed(id, spec);
  service.reset();
  EXPECT_THAT(told, ::testing::Contains(HasSubstr("is still run by what was launched for it before")));
  while (!process.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(process.exit_code(), 0);
}

}  // namespace
}  // namespace steerstat::testing
