#include "trial/cvode_runner.hpp"

#include "trial/course.hpp"

namespace steerstat {

CvodeRunner::CvodeRunner(double tolerance) : integrator_(tolerance) {}

void CvodeRunner::run(TrialStream& stream) {
  std::uint64_t index = 0;
  TrialParameters parameters;
  while (stream.next(index, parameters)) {
    const ClosedLoop<double> loop = closed_loop_of(parameters);
    stream.finished(index,
                    run_course(parameters, [&](const Phase& phase, double t, const State<double>& x, double t_end) {
                      return integrator_.advance(loop, phase, t, x, t_end);
                    }));
  }
}

}  // namespace steerstat
