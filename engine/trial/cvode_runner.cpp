#include "trial/cvode_runner.hpp"

#include "trial/check_in_interval.hpp"
#include "trial/course.hpp"

namespace steerstat {
namespace {

/// Lets the stream end a phase of millions of steps.
class CheckingIn final : public StepObserver {
 public:
  explicit CheckingIn(TrialStream& stream) : stream_(stream) {}
  void step(double, double, const DenseOutput&) override {
    if (interval_.ends_with_step()) stream_.check_in();
  }

 private:
  TrialStream& stream_;
  CheckInInterval interval_{};
};

}  // namespace

CvodeRunner::CvodeRunner(double tolerance, bool metrics) : integrator_(tolerance), metrics_(metrics) {}

void CvodeRunner::run(TrialStream& stream) {
  std::uint64_t index = 0;
  TrialParameters parameters;
  CheckingIn observer(stream);
  while (stream.next(index, parameters)) {
    const ClosedLoop<double> loop = closed_loop_of(parameters);
    Exertion exertion = exertion_at(parameters.start, parameters.goal.q1);
    Exertion* measured = metrics_ ? &exertion : nullptr;
    TrialOutcome outcome =
        run_course(parameters, exertion, [&](const Phase& phase, double t, const State<double>& x, double t_end) {
          return integrator_.advance(loop, phase, t, x, t_end, &observer, measured);
        });
    if (metrics_) report_exertion(exertion, outcome);
    stream.finished(index, outcome);
  }
}

}  // namespace steerstat
