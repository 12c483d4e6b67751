#pragma once

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <memory>
#include <type_traits>

#include "core/state.hpp"

/// SUNDIALS' objects, which end with their owners, and states in its vectors.
namespace steerstat {

struct StateVectorDeleter {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
using StateVector = std::unique_ptr<std::remove_pointer_t<N_Vector>, StateVectorDeleter>;

struct NonlinearSolverDeleter {
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
using NonlinearSolver = std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, NonlinearSolverDeleter>;

struct CvodeMemoryDeleter {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
using CvodeMemory = std::unique_ptr<void, CvodeMemoryDeleter>;

inline constexpr sunindextype state_size = 4;

inline State<double> state_of(N_Vector v) {
  const realtype* y = N_VGetArrayPointer(v);
  return {y[0], y[1], y[2], y[3]};
}

inline void store(const State<double>& x, N_Vector v) {
  realtype* y = N_VGetArrayPointer(v);
  y[0] = x.q1;
  y[1] = x.q2;
  y[2] = x.q1_dot;
  y[3] = x.q2_dot;
}

}  // namespace steerstat
