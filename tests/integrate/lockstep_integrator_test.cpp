#include "integrate/lockstep_integrator.hpp"

#include <gtest/gtest.h>

#include "core/errors.hpp"

#include "imperfection_suite.hpp"
#include "integrator_suite.hpp"

namespace steerstat::testing {
namespace {

std::vector<InstructionSet> supported_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::portable}) {
    if (supports(set)) sets.push_back(set);
  }
  return sets;
}

/// A lockstep engine on every lane of every instruction set of this machine, which must all agree to the bit.
template <LoopKind kind>
class EveryLane {
 public:
  explicit EveryLane(double tolerance) : tolerance_(tolerance) {}

  Arrival advance(const ClosedLoop<double>& loop, const Phase& phase, double t, const State<double>& x, double t_end,
                  StepObserver* observer = nullptr, Exertion* exertion = nullptr) const {
    const Exertion before = exertion != nullptr ? *exertion : Exertion{};
    const Arrival first = LockstepIntegrator(tolerance_, best_instruction_set(), 0, kind)
                              .advance(loop, phase, t, x, t_end, observer, exertion);
    for (const InstructionSet set : supported_sets()) {
      const int lanes = make_lockstep_engine(tolerance_, set, kind)->lanes();
      for (int lane = 0; lane < lanes; ++lane) {
        Exertion again = before;
        const Arrival other = LockstepIntegrator(tolerance_, set, lane, kind)
                                  .advance(loop, phase, t, x, t_end, nullptr, exertion != nullptr ? &again : nullptr);
        EXPECT_TRUE(exertion == nullptr || again == *exertion) << name_of(set) << " lane " << lane;
        EXPECT_EQ(bits_of(other), bits_of(first)) << name_of(set) << " lane " << lane;
        EXPECT_EQ(other.cause, first.cause);
      }
    }
    return first;
  }

 private:
  double tolerance_;
};

using Ideal = EveryLane<LoopKind::ideal>;
using Imperfect = EveryLane<LoopKind::imperfect>;

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Lockstep, IntegratorMotion, Ideal);
INSTANTIATE_TYPED_TEST_SUITE_P(Lockstep, IntegratorGuards, Ideal);
INSTANTIATE_TYPED_TEST_SUITE_P(Lockstep, IntegratorExertion, Ideal);
INSTANTIATE_TYPED_TEST_SUITE_P(ImperfectLockstep, IntegratorMotion, Imperfect);
INSTANTIATE_TYPED_TEST_SUITE_P(ImperfectLockstep, IntegratorGuards, Imperfect);
INSTANTIATE_TYPED_TEST_SUITE_P(ImperfectLockstep, IntegratorImperfections, Imperfect);
INSTANTIATE_TYPED_TEST_SUITE_P(ImperfectLockstep, IntegratorExertion, Imperfect);

namespace {

TEST(LockstepIntegrator, ANonFiniteStartFails) {
  LockstepIntegrator integrator(1e-9);
  for (const double bad : {infinity, not_a_number}) {
    EXPECT_EQ(integrator.advance(exact_loop(), align_phase(1e-3), 1.0, {bad, 0.7, 0.0, 0.1}, 2.0).cause,
              Cause::failure);
    EXPECT_EQ(integrator.advance(exact_loop(), align_phase(1e-3), 1.0, {1.0, bad, 0.0, 0.1}, 2.0).cause,
              Cause::failure);
    EXPECT_EQ(integrator.advance(exact_loop(), align_phase(1e-3), 1.0, {1.0, 0.7, 0.0, bad}, 2.0).cause,
              Cause::failure);
  }
}

TEST(LockstepIntegrator, ALawThatIsNotFiniteFails) {
  LockstepIntegrator integrator(1e-9);
  EXPECT_EQ(integrator.advance(exact_loop(), cycle_phase(infinity, 2.0), 0.0, {0.0, 0.7, 0.0, 0.1}, 2.0).cause,
            Cause::failure);
}

TEST(LockstepIntegrator, APlantTooStiffForStepsOfAPicosecondFails) {
  LockstepIntegrator integrator(1e-9);
  ClosedLoop<double> loop = exact_loop();
  loop.plant.f2 = 1e15;
  EXPECT_EQ(integrator.advance(loop, drift_phase(-10.0, 10.0), 0.0, {0.0, 0.7, 0.0, 0.1}, 2.0).cause, Cause::failure);
}

TEST(LockstepEngine, ATrialThatFailsDisturbsNoOtherLane) {
  for (const InstructionSet set : supported_sets()) {
    const auto engine = make_lockstep_engine(1e-9, set);
    const State<double> x0{1.0, 0.7, 0.0, 0.1};
    const Phase phase = align_phase(1e-3);
    engine->seat(0, exact_loop());
    engine->start(0, phase, 0.0, x0, 20.0);
    engine->seat(1, exact_loop());
    engine->start(1, phase, 0.0, {1.0, not_a_number, 0.0, 0.1}, 20.0);
    bool failed = false;
    std::uint64_t ended = 0;
    while ((ended & 1u) == 0) {
      ended = engine->step();
      if ((ended & 2u) != 0) {
        EXPECT_EQ(engine->arrival(1).cause, Cause::failure);
        engine->vacate(1);
        failed = true;
      }
    }
    EXPECT_TRUE(failed);
    EXPECT_EQ(bits_of(engine->arrival(0)),
              bits_of(LockstepIntegrator(1e-9, set).advance(exact_loop(), phase, 0.0, x0, 20.0)));
  }
}

TEST(LockstepEngine, AnInstructionSetThatIsNotThereIsRefused) {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::portable}) {
    if (supports(set)) {
      EXPECT_EQ(make_lockstep_engine(1e-9, set)->instruction_set(), set);
    } else {
      EXPECT_THROW((void)make_lockstep_engine(1e-9, set), BadUsage);
    }
  }
}

}  // namespace
}  // namespace steerstat::testing
