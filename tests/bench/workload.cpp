#include "workload.hpp"

#include <fstream>
#include <sstream>
#include <string>

#include "core/errors.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat::bench {

Study combined_study(std::uint64_t trials) {
  const std::string directory = std::string(STEERSTAT_SOURCE_DIR) + "/studies/specs/robustness";
  std::ifstream file(directory + "/combined.json");
  if (!file) throw RunFailure("cannot read " + directory + "/combined.json");
  std::ostringstream text;
  text << file.rdbuf();
  Study study = decode_study(text.str(), directory);
  study.sampling.trials = trials;
  study.retention = {};
  study.audited_trials = 0;
  return study;
}

Run run_trials(std::uint64_t trials, const MakeRunner& make_runner, unsigned threads) {
  const Study study = combined_study(trials);
  RunOptions options;
  options.threads = threads;
  options.make_runner = [&](const IntegratorChoice&) { return make_runner(); };
  Run run;
  run.duration = time_of([&] { run.outcomes = run_study(study, options).trials.outcomes; });
  return run;
}

}  // namespace steerstat::bench
