#pragma once

#include <cstdint>
#include <string>

#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {

/// A study of short trials that retains and audits some.
inline Study resumable(std::uint64_t trials, const std::string& method = "lockstep", const std::string& more = "") {
  return decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}}, "horizon": 20,
      "retain": {"trajectories": {"first": 1, "failed": 2}}, "audit": {"trials": 2}, "integrator": {"method": ")" +
                          method + R"("}, "sampling": {"trials": )" + std::to_string(trials) + "}" + more + "}",
                      {});
}

/// The rows of `whole` whose indices pass.
template <class Passes>
FinishedTrials part_of(const StudyResult& whole, const Passes& passes) {
  FinishedTrials part;
  for (std::size_t row = 0; row < whole.trials.index.size(); ++row) {
    if (!passes(whole.trials.index[row])) continue;
    part.trials.index.push_back(whole.trials.index[row]);
    part.trials.outcomes.push_back(whole.trials.outcomes[row]);
  }
  return part;
}

}  // namespace steerstat
