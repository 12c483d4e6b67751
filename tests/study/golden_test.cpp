// The outcomes of small studies, pinned to the bit, so that a change which moves any of them is seen. A change that is
// meant to move them renews a hash here: the failing test tells the new one. Say in the commit what moved and why.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <numeric>
#include <ostream>
#include <string>

#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

/// FNV-1a of 64 bits, word by word.
class Hash {
 public:
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3U; }
  void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_{0xcbf29ce484222325U};
};

void add_course(Hash& hash, const TrialOutcome& outcome) {
  hash.add(static_cast<std::uint64_t>(outcome.status));
  hash.add(std::uint64_t{outcome.cycles});
  hash.add(std::uint64_t{outcome.swings});
  hash.add(std::uint64_t{outcome.alignments});
}

std::uint64_t hash_of_courses(const TrialTable& trials) {
  Hash hash;
  for (const TrialOutcome& outcome : trials.outcomes) add_course(hash, outcome);
  return hash.value();
}

/// Of every bit but the sign and the payload of NaNs, which are as the processor likes.
std::uint64_t hash_of_bits(const TrialTable& trials) {
  Hash hash;
  for (const TrialOutcome& o : trials.outcomes) {
    add_course(hash, o);
    for (const double x :
         {o.end_time, o.end_state.q1, o.end_state.q2, o.end_state.q1_dot, o.end_state.q2_dot, o.passive_error,
          o.active_error, o.effort, o.peak_acceleration, o.peak_force, o.peak_stroke, o.position_contraction.mean,
          o.position_contraction.worst, o.velocity_contraction.mean, o.velocity_contraction.worst}) {
      hash.add(x == x ? x : no_value);
    }
  }
  return hash.value();
}

/// The combined study with `extra` keys.
TrialTable run(const std::string& extra, std::uint64_t trials) {
  Study study =
      decode_study(R"({
    "plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]},
              "f1": {"uniform": [0, 0.05]}, "f2": {"uniform": [0, 0.05]})" +
                       std::string(extra.starts_with("in plant: ") ? ", " + extra.substr(10) : "}, " + extra) + R"(,
    "initial_state": {"q1": {"uniform": [-1, 1]}, "q2": {"uniform": [-3.14159, 3.14159]},
                      "q1_dot": {"uniform": [-0.5, 0.5]}, "q2_dot": {"uniform": [-0.5, 0.5]}},
    "sampling": {"trials": 1000, "seed": 11},
    "audit": {"trials": 0}})",
                   {});
  study.sampling.trials = trials;
  return run_study(study, {.threads = 1}).trials;
}

struct Pinned {
  const char* name;
  const char* extra;  ///< keys of the spec
  std::uint64_t hash;
};

void PrintTo(const Pinned& pinned, std::ostream* stream) {
  *stream << pinned.extra;
}

class GoldenOutcomes : public ::testing::TestWithParam<Pinned> {};

TEST_P(GoldenOutcomes, OfLockstepAreTheSameBitsAsEver) {
  const std::uint64_t hash = hash_of_bits(run(GetParam().extra, 200));
  EXPECT_EQ(hash, GetParam().hash) << std::hex << "outcomes have changed; where that is meant, the hash is now 0x"
                                   << hash << 'U';
}

INSTANTIATE_TEST_SUITE_P(
    Lockstep, GoldenOutcomes,
    ::testing::Values(Pinned{"defaults", R"("name": "defaults")", 0x2820ea2c385f90fcU},
                      Pinned{"never_realigned", R"("controller": {"realignment": "never"})", 0x8717dcfadf9883e0U},
                      Pinned{"always_realigned",
                             R"("controller": {"realignment": "always", "drift": {"min_speed": 0.05}})",
                             0x5d980e1fb04e3b63U},
                      Pinned{"other_goal", R"("goal": {"q1": 0.3, "q2": 2.2}, "horizon": 120)", 0x31ae0ad40b30f190U},
                      Pinned{"loose", R"("integrator": {"tolerance": 1e-6})", 0x170253d4c1fe5d8aU},
                      Pinned{"without_metrics", R"("metrics": false)", 0x243867b36f60c95cU},
                      Pinned{"imperfect",
                             R"(in plant: "coulomb1": 0.003, "coulomb2": 2e-5, "gravity_x": 1e-4},
                  "actuator": {"gain": 1.02, "max_force": 20},
                  "sensor": {"bias": {"q1": 0.001}, "noise": {"q1": 1e-4, "q2": 1e-4}})",
                             0x36f6ac4a5c3bc236U}),
    [](const auto& pinned) { return std::string(pinned.param.name); });

/// SUNDIALS computes with the C library, whose last bits are another's on another system: its decisions are pinned, and
/// its times as far as its tolerance goes.
TEST(GoldenOutcomes, OfTheReferenceTakeTheSameCoursesAsEver) {
  const TrialTable trials = run(R"("integrator": {"method": "cvode", "tolerance": 1e-11}, "horizon": 100)", 30);
  EXPECT_EQ(hash_of_courses(trials), 0xa995e18e2c62f2b5U)
      << std::hex << "the hash is now 0x" << hash_of_courses(trials) << 'U';
  const double times = std::transform_reduce(trials.outcomes.begin(), trials.outcomes.end(), 0.0, std::plus<>(),
                                             [](const TrialOutcome& o) { return o.end_time; });
  EXPECT_NEAR(times, 2459.4420483, 1e-5);
  EXPECT_EQ(hash_of_courses(run(R"("integrator": {"tolerance": 1e-11}, "horizon": 100)", 30)), hash_of_courses(trials));
}

}  // namespace
}  // namespace steerstat
