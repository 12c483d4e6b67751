#include "integrate/cvode_integrator.hpp"

#include <gtest/gtest.h>

#include "imperfection_suite.hpp"
#include "integrator_suite.hpp"

namespace steerstat::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(Cvode, IntegratorMotion, CvodeIntegrator);
INSTANTIATE_TYPED_TEST_SUITE_P(Cvode, IntegratorGuards, CvodeIntegrator);
INSTANTIATE_TYPED_TEST_SUITE_P(Cvode, IntegratorExertion, CvodeIntegrator);
INSTANTIATE_TYPED_TEST_SUITE_P(Cvode, IntegratorImperfections, CvodeIntegrator);

namespace {

TEST(CvodeIntegrator, AnEmptyIntervalArrivesAtOnce) {
  CvodeIntegrator integrator(1e-9);
  const State<double> x0{1.0, 0.7, 0.0, 0.1};
  for (const double t_end : {5.0, 4.0, not_a_number}) {
    const Arrival arrival = integrator.advance(exact_loop(), align_phase(1e-3), 5.0, x0, t_end);
    EXPECT_EQ(arrival.cause, Cause::time);
    EXPECT_EQ(arrival.t, 5.0);
    EXPECT_EQ(arrival.state, x0);
  }
}

TEST(CvodeIntegrator, AnIntervalShorterThanTheLeastStepIsCrossed) {
  CvodeIntegrator integrator(1e-9);
  const Arrival arrival = integrator.advance(exact_loop(), align_phase(1e-3), 0.0, {1.0, 0.7, 0.0, 0.1}, 1e-13);
  EXPECT_EQ(arrival.cause, Cause::time);
  EXPECT_EQ(arrival.t, 1e-13);
  EXPECT_NEAR(arrival.state.q1_dot, -7e-13, 1e-16);
}

TEST(CvodeIntegrator, ANonFiniteStartFailsWhereItIs) {
  CvodeIntegrator integrator(1e-9);
  for (const double bad : {infinity, not_a_number}) {
    EXPECT_EQ(integrator.advance(exact_loop(), align_phase(1e-3), 1.0, {bad, 0.7, 0.0, 0.1}, 2.0).cause,
              Cause::failure);
    const Arrival arrival = integrator.advance(exact_loop(), align_phase(1e-3), 1.0, {1.0, 0.7, 0.0, bad}, 2.0);
    EXPECT_EQ(arrival.cause, Cause::failure);
    EXPECT_EQ(arrival.t, 1.0);
  }
}

TEST(CvodeIntegrator, ALawThatIsNotFiniteFailsInSilence) {
  CvodeIntegrator integrator(1e-9);
  ::testing::internal::CaptureStderr();
  const Arrival arrival = integrator.advance(exact_loop(), cycle_phase(infinity, 2.0), 0.0, {0.0, 0.7, 0.0, 0.1}, 2.0);
  EXPECT_EQ(arrival.cause, Cause::failure);
  EXPECT_EQ(arrival.t, 0.0);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(CvodeIntegrator, APlantTooStiffForStepsOfAPicosecondFailsInSilence) {
  CvodeIntegrator integrator(1e-9);
  ::testing::internal::CaptureStderr();
  for (const double f1 : {3e12, 1e14, 1e300}) {
    ClosedLoop<double> loop = exact_loop();
    loop.plant.f1 = f1;
    EXPECT_EQ(integrator.advance(loop, align_phase(1e-3), 0.0, {1.0, 0.7, 1.0, 0.1}, 2.0).cause, Cause::failure) << f1;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  const Arrival next = integrator.advance(exact_loop(), align_phase(1e-3), 0.0, {1.0, 0.7, 1.0, 0.1}, 200.0);
  EXPECT_EQ(next.cause, Cause::guard) << "a failure leaves nothing behind";
}

TEST(CvodeIntegrator, TakesATolerancePastWhatDoublesResolve) {
  CvodeIntegrator integrator(1e-30);
  const Oscillator oscillator{0.1, 2.0};
  const Arrival arrival = integrator.advance(oscillator.loop(), align_phase(-1.0), 0.0, {1.0, 0.7, 0.0, 0.1}, 3.0);
  ASSERT_EQ(arrival.cause, Cause::time);
  EXPECT_NEAR(arrival.state.q1, oscillator.at(3.0)[0], 1e-12);
}

}  // namespace
}  // namespace steerstat::testing
