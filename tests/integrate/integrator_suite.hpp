#pragma once

#include "exertion_suite.hpp"
#include "guard_suite.hpp"
#include "motion_suite.hpp"

/// What every integrator must do. An integrator is a class that is constructed from a tolerance and has
/// `advance(loop, phase, t0, x0, t_end, observer, exertion) -> Arrival`; to put one under test:
///
///     INSTANTIATE_TYPED_TEST_SUITE_P(Name, IntegratorMotion, Integrator);
///     INSTANTIATE_TYPED_TEST_SUITE_P(Name, IntegratorGuards, Integrator);
///     INSTANTIATE_TYPED_TEST_SUITE_P(Name, IntegratorExertion, Integrator);
