#include "study/continuation.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "resumable_study.hpp"
#include "study/plan.hpp"

namespace steerstat {
namespace {

TEST(Continuation, IsTheSameStudyWithAsManyDrawsOrMore) {
  const Study study = resumable(100);
  EXPECT_TRUE(continues(study, study));
  EXPECT_TRUE(continues(resumable(101), study));
  EXPECT_FALSE(continues(resumable(99), study));
  EXPECT_EQ(trials_sha256(resumable(101)), trials_sha256(study));
  EXPECT_NE(spec_sha256(resumable(101)), spec_sha256(study));
}

TEST(Continuation, IsNoStudyThatDiffersInAnythingElse) {
  const Study study = resumable(100);
  Study other = study;
  other.sampling.seed = 2;
  EXPECT_FALSE(continues(other, study));
  EXPECT_NE(trials_sha256(other), trials_sha256(study));
  EXPECT_FALSE(continues(resumable(100, "cvode"), study));
  EXPECT_FALSE(continues(resumable(200, "lockstep", R"(, "name": "other")"), study));
}

TEST(Continuation, DependsOnWhetherMoreDrawsKeepTheFirstOnes) {
  for (const SamplingMethod method :
       {SamplingMethod::monte_carlo, SamplingMethod::sobol, SamplingMethod::sobol_indices}) {
    Study study = resumable(100);
    study.sampling.method = method;
    Study longer = study;
    longer.sampling.trials = 200;
    EXPECT_TRUE(continues(longer, study));
    const Plan plan(study);
    const Plan longer_plan(longer);
    std::vector<double> drawn(plan.varying().size());
    std::vector<double> drawn_longer(drawn.size());
    for (std::uint64_t i = 0; i < 100; ++i) {
      plan.draw(i, drawn);
      longer_plan.draw(i, drawn_longer);
      EXPECT_EQ(drawn, drawn_longer);
    }
  }
  Study hypercube = resumable(100);
  hypercube.sampling.method = SamplingMethod::latin_hypercube;
  Study longer = hypercube;
  longer.sampling.trials = 200;
  EXPECT_FALSE(continues(longer, hypercube));
  EXPECT_TRUE(continues(hypercube, hypercube));
}

}  // namespace
}  // namespace steerstat
