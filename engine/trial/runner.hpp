#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "core/instruction_set.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// Which engine simulates the trials, and how precisely.
struct IntegratorChoice {
  enum class Method : std::uint8_t { lockstep = 0, cvode = 1 };
  static constexpr std::array<std::string_view, 2> method_names{"lockstep", "cvode"};

  Method method{Method::lockstep};
  double tolerance{1e-9};  ///< of a step's local error [m/s, rad/s]; each engine says how it takes it
  bool metrics{true};      ///< whether effort and peaks are measured; the rest of an outcome is the same bits

  friend bool operator==(const IntegratorChoice&, const IntegratorChoice&) = default;
};

/// A supply of trials and the place their outcomes go to. A runner calls it from its own thread alone.
class TrialStream {
 public:
  virtual ~TrialStream() = default;

  /// Writes the next trial's index and parameters. @return false when there is no further trial (now or ever).
  virtual bool next(std::uint64_t& index, TrialParameters& parameters) = 0;

  /// Takes the outcome of trial `index`; outcomes come in any order.
  virtual void finished(std::uint64_t index, const TrialOutcome& outcome) = 0;

  /// Called every few milliseconds while trials are in flight; may wait. What it throws leaves the runner, and those
  /// trials are given up.
  virtual void check_in() {}
};

/// Simulates trials one stream at a time. Not thread-safe: one runner a thread. An outcome depends on the trial's
/// parameters and the integrator alone, never on the stream, the order or the trials beside it.
class TrialRunner {
 public:
  virtual ~TrialRunner() = default;

  /// Runs `stream` dry. May be called again, also after a stream has thrown.
  virtual void run(TrialStream& stream) = 0;

  /// Runs one trial. @param check_in  as a stream's
  TrialOutcome run(const TrialParameters& parameters, const std::function<void()>& check_in = {});
};

/// @param set  what lockstep runs on; the outcomes are the same bits on each
/// @throws RunFailure where the engine cannot be set up, BadUsage where this machine does not run `set`
std::unique_ptr<TrialRunner> make_runner(const IntegratorChoice& integrator,
                                         InstructionSet set = best_instruction_set());

}  // namespace steerstat
