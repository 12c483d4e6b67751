#include "integrate/cvode_integrator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "core/errors.hpp"
#include "integrate/cvode_objects.hpp"
#include "integrate/exertion_meter.hpp"
#include "integrate/step_polynomial.hpp"

namespace steerstat {
namespace {

constexpr double guard_precision = 1e-10;  // [s] crossings closer than this are one
constexpr double finest = 1e-15;           // relative error that doubles still tell apart
constexpr double coarsest = 1e3;           // how much a stalled method's tolerances are loosened, at most
constexpr long start_steps = 50;           // CVODE starts at order 1, with steps far shorter than those to come
constexpr long most_steps = 10'000'000;    // in one phase; the pace of a step a microsecond makes more of them a hang

bool is_finite(const State<double>& x) {
  return std::isfinite(x.q1) && std::isfinite(x.q2) && std::isfinite(x.q1_dot) && std::isfinite(x.q2_dot);
}

void require(bool succeeded, const char* call) {
  if (!succeeded) throw RunFailure(std::string("SUNDIALS cannot be set up: ") + call + " failed");
}

// CVODE would print to stderr; its return codes say enough.
void stay_silent(int, const char*, const char*, char*, void*) {}

/// What CVODE's callbacks see of the phase under way; times are since the phase's start.
struct PhaseContext {
  ClosedLoop<double> loop;
  Phase phase;
};

State<double> closed_loop_rate(const PhaseContext& context, double t, const State<double>& x) {
  const double a = commanded_acceleration(context.loop, context.phase, t, x);
  // The C library's sine on purpose: the reference shares no elementary function with the engine it is to check.
  return derivative(context.loop, a, x, std::sin(x.q2), std::cos(x.q2));
}

int right_hand_side(realtype t, N_Vector y, N_Vector y_dot, void* user) {
  const State<double> rate = closed_loop_rate(*static_cast<const PhaseContext*>(user), t, state_of(y));
  store(rate, y_dot);
  return is_finite(rate) ? 0 : 1;  // 1: try again with a shorter step
}

/// How much more force [N] the actuator could give than it is asked for: where this changes its sign, the closed loop
/// has a kink.
double spare_force(const PhaseContext& context, double t, const State<double>& x) {
  const auto& [loop, phase] = context;
  if (!(loop.actuator.max_force < Phase::unbounded)) return Phase::unbounded;
  const double a = commanded_acceleration(loop, phase, t, x);
  const double asked = loop.actuator.gain * demanded_force(loop, a, x, std::sin(x.q2), std::cos(x.q2));
  return loop.actuator.max_force - std::abs(asked);
}

/// The guards, and after them the spare force.
constexpr std::size_t root_count = guard_count + 1;
constexpr std::size_t kink = guard_count;

int root_functions(realtype t, N_Vector y, realtype* g, void* user) {
  const auto& context = *static_cast<const PhaseContext*>(user);
  const State<double> x = state_of(y);
  const std::array<double, guard_count> values = guards(context.loop, context.phase, x);
  for (std::size_t i = 0; i < guard_count; ++i) {
    // CVODE puts a function that starts at exactly 0 out of action, and would leave it so in phases to come.
    g[i] = (t == 0.0 && values[i] == 0.0) ? -std::numeric_limits<double>::min() : values[i];
  }
  g[kink] = spare_force(context, t, x);
  return 0;
}

}  // namespace

struct CvodeIntegrator::Solver final : DenseOutput {
  explicit Solver(double wanted);

  Arrival advance(double t0, const State<double>& x0, double t_end, StepObserver* observer, ExertionMeter* meter);

  /// The state at t [s] since the trial's start, within the last step.
  [[nodiscard]] State<double> at(double t) const override { return interpolate(t - origin); }

  [[nodiscard]] State<double> interpolate(double t) const;
  [[nodiscard]] StepPolynomial step_polynomial(double from, double to) const;

  /// A moment of the phase, with what the guards need of it.
  struct Moment {
    double t;  // [s] since the phase's start
    State<double> x;
    std::array<double, guard_count> guards;
    std::array<double, guard_count> rates;  // the most that |d guard / dt| can be here
  };
  [[nodiscard]] Moment moment(double t, const State<double>& x) const;
  std::optional<double> find_crossing(const Moment& before, const Moment& after, bool rooted, double to);
  [[nodiscard]] bool restart(double now, double duration);
  [[nodiscard]] bool loosen(double factor);
  [[nodiscard]] bool guard_rooted() const;
  [[nodiscard]] double step_end() const;

  sundials::Context context;
  StateVector y;
  StateVector work;
  NonlinearSolver nonlinear_solver;
  CvodeMemory cvode;
  PhaseContext user{};
  double tolerance;                       // as asked for
  double looseness{1.0};                  // of the tolerances in force, over those asked for
  double origin{0.0};                     // [s] the phase's start
  std::array<bool, guard_count> armed{};  // the guard has been positive in this phase
};

CvodeIntegrator::Solver::Solver(double wanted)
    : y(N_VNew_Serial(state_size, context)),
      work(N_VNew_Serial(state_size, context)),
      nonlinear_solver(y ? SUNNonlinSol_FixedPoint(y.get(), 0, context) : nullptr),
      cvode(CVodeCreate(CV_ADAMS, context)),
      tolerance(wanted) {
  require(y && work, "N_VNew_Serial");
  require(nonlinear_solver != nullptr, "SUNNonlinSol_FixedPoint");
  require(cvode != nullptr, "CVodeCreate");
  void* memory = cvode.get();
  std::array<int, root_count> directions{};
  directions.fill(-1);
  directions[kink] = 0;
  N_VConst(0.0, y.get());
  require(N_VEnableFusedOps_Serial(y.get(), SUNTRUE) == 0, "N_VEnableFusedOps_Serial");  // CVODE's vectors are clones
  require(CVodeSetErrHandlerFn(memory, stay_silent, nullptr) == CV_SUCCESS, "CVodeSetErrHandlerFn");
  require(CVodeInit(memory, right_hand_side, 0.0, y.get()) == CV_SUCCESS, "CVodeInit");
  require(CVodeSetUserData(memory, &user) == CV_SUCCESS, "CVodeSetUserData");
  require(loosen(1.0), "CVodeSVtolerances");
  require(CVodeSetNonlinearSolver(memory, nonlinear_solver.get()) == CV_SUCCESS, "CVodeSetNonlinearSolver");
  require(CVodeSetMaxHnilWarns(memory, -1) == CV_SUCCESS, "CVodeSetMaxHnilWarns");
  require(CVodeRootInit(memory, root_count, root_functions) == CV_SUCCESS, "CVodeRootInit");
  require(CVodeSetRootDirection(memory, directions.data()) == CV_SUCCESS, "CVodeSetRootDirection");
  require(CVodeSetNoInactiveRootWarn(memory) == CV_SUCCESS, "CVodeSetNoInactiveRootWarn");
}

State<double> CvodeIntegrator::Solver::interpolate(double t) const {
  double now = 0.0;
  double width = 0.0;
  CVodeGetCurrentTime(cvode.get(), &now);
  CVodeGetLastStep(cvode.get(), &width);
  // Rounding may put t a little outside the step, where CVODE refuses.
  CVodeGetDky(cvode.get(), std::clamp(t, now - width, now), 0, work.get());
  return state_of(work.get());
}

/// [s] since the phase's start: where the last step ended, which is beyond a root found within it.
double CvodeIntegrator::Solver::step_end() const {
  double now = 0.0;
  CVodeGetCurrentTime(cvode.get(), &now);
  return now;
}

/// The last step's dense output on a part of it. @param from, to  [s]
StepPolynomial CvodeIntegrator::Solver::step_polynomial(double from, double to) const {
  int order = 0;
  CVodeGetLastOrder(cvode.get(), &order);
  StepPolynomial step;
  step.start = from;
  step.width = to - from;
  step.order = static_cast<std::size_t>(order);
  double scale = 1.0;  // width^k / k!
  for (int k = 0; k <= order; ++k) {
    if (k > 0) scale *= step.width / k;
    CVodeGetDky(cvode.get(), from, k, work.get());
    const State<double> d = state_of(work.get());
    step.coefficients[static_cast<std::size_t>(k)] = {scale * d.q1, scale * d.q2, scale * d.q1_dot, scale * d.q2_dot};
  }
  return step;
}

/// Whether the root that CVODE has just returned is one of a guard.
bool CvodeIntegrator::Solver::guard_rooted() const {
  std::array<int, root_count> found{};
  CVodeGetRootInfo(cvode.get(), found.data());
  return std::any_of(found.begin(), found.begin() + guard_count, [](int sign) { return sign != 0; });
}

/// Puts tolerances of `factor` times those asked for in force. @return whether that went well
bool CvodeIntegrator::Solver::loosen(double factor) {
  // CVODE's estimate is of one step's error, and steps are many: its tolerances are finer than what they should add up
  // to. The passive joint coasts on its speed for up to minutes, so that is held finest.
  const double relative = factor * std::max(tolerance / 100.0, finest);
  const double absolute = factor * std::max(tolerance / 20.0, finest);
  store({absolute, absolute, absolute, relative}, work.get());
  looseness = factor;
  return CVodeSVtolerances(cvode.get(), relative, work.get()) == CV_SUCCESS;
}

/// Starts the method anew where y stands, so that no step reaches over a kink. @return whether that went well
bool CvodeIntegrator::Solver::restart(double now, double duration) {
  return CVodeReInit(cvode.get(), now, y.get()) == CV_SUCCESS && CVodeSetStopTime(cvode.get(), duration) == CV_SUCCESS;
}

CvodeIntegrator::Solver::Moment CvodeIntegrator::Solver::moment(double t, const State<double>& x) const {
  Moment moment{t, x, guards(user.loop, user.phase, x), {}};
  if (user.phase.kind == PhaseKind::align || user.phase.kind == PhaseKind::drift) {
    const State<double> rate = closed_loop_rate(user, t, x);
    const double active = std::sqrt(rate.q1 * rate.q1 + rate.q1_dot * rate.q1_dot);
    const auto [kp, kd] = align_gains(user.loop, user.phase);
    moment.rates = {active, std::abs(rate.q2), std::abs(rate.q2), std::abs(rate.q2_dot),
                    std::abs(kp * rate.q1 + kd * rate.q1_dot)};
  }
  return moment;
}

/// The first time [s] a guard fires in the step from `before` to `after`, other than at `after` itself.
///
/// CVODE looks at a step's ends, so it misses a guard that dips below zero and returns, and of several crossings it may
/// find any. The step's polynomial is searched wherever a guard moves fast enough to have dipped.
///
/// @param rooted  whether `after` is a root of a guard that CVODE found
/// @param to      how far the step's polynomial counts [s]
std::optional<double> CvodeIntegrator::Solver::find_crossing(const Moment& before, const Moment& after, bool rooted,
                                                             double to) {
  constexpr double rate_margin = 4.0;  // how much faster than at its ends a guard may move within a step
  std::optional<StepPolynomial> step;
  std::optional<double> first;
  double width = 0.0;
  CVodeGetLastStep(cvode.get(), &width);
  for (std::size_t i = 0; i < guard_count; ++i) {
    if (!(before.guards[i] < Phase::unbounded)) continue;
    const double reach = rate_margin * width * std::max(before.rates[i], after.rates[i]);
    const bool apart = before.guards[i] > 0.0 && after.guards[i] > 0.0 && before.guards[i] + after.guards[i] > reach;
    if (armed[i] && apart) continue;
    if (!step) step = step_polynomial(before.t, to);
    const std::optional<double> crossing = first_crossing(*step, user.loop, user.phase, i, armed[i]);
    if (crossing && (!first || *crossing < *first)) first = crossing;
  }
  const bool same_as_root = rooted && first && *first > after.t - guard_precision;
  return same_as_root ? std::nullopt : first;
}

Arrival CvodeIntegrator::Solver::advance(double t0, const State<double>& x0, double t_end, StepObserver* observer,
                                         ExertionMeter* meter) {
  const double duration = t_end - t0;
  if (!(duration > 0.0)) return {t0, x0, Cause::time};
  if (!is_finite(x0)) return {t0, x0, Cause::failure};
  origin = t0;
  store(x0, y.get());
  if ((looseness > 1.0 && !loosen(1.0)) || !restart(0.0, duration)) return {t0, x0, Cause::failure};

  Moment before = moment(0.0, x0);
  for (std::size_t i = 0; i < guard_count; ++i) armed[i] = before.guards[i] > 0.0;
  long started = 0;  // the step before which the method began
  for (long steps = 0; steps < most_steps; ++steps) {
    double now = 0.0;
    const int flag = CVode(cvode.get(), duration, y.get(), &now, CV_ONE_STEP);
    if (flag < 0) return {t0 + before.t, before.x, Cause::failure};
    const bool rooted = flag == CV_ROOT_RETURN && guard_rooted();
    const bool kinked = flag == CV_ROOT_RETURN && !rooted;
    const bool ended = flag == CV_TSTOP_RETURN || (kinked && duration - now <= least_step);
    const Moment after = moment(now, state_of(y.get()));
    const std::optional<double> crossing = find_crossing(before, after, rooted, kinked ? now : step_end());
    const double t = ended && !crossing ? t_end : std::min(t0 + crossing.value_or(now), t_end);
    if (observer != nullptr) observer->step(t0 + before.t, t, *this);
    if (meter != nullptr) meter->step(t0 + before.t, t, *this);
    if (crossing) return {t, interpolate(*crossing), Cause::guard};
    if (rooted) return {t, after.x, Cause::guard};
    if (ended) return {t, after.x, Cause::time};
    // Where the rounding of the motion's rate, not its bend, makes CVODE's steps shrink without end, tolerances that
    // doubles can meet let it go on.
    const bool stalled = !kinked && now - before.t < least_step && steps - started >= start_steps;
    if (stalled && (looseness >= coarsest || !loosen(10.0 * looseness))) return {t, after.x, Cause::failure};
    if (kinked || stalled) {
      if (!restart(now, duration)) return {t, after.x, Cause::failure};
      started = steps + 1;
    }
    before = after;
  }
  return {t0 + before.t, before.x, Cause::failure};
}

CvodeIntegrator::CvodeIntegrator(double tolerance) : solver_(std::make_unique<Solver>(tolerance)) {}
CvodeIntegrator::~CvodeIntegrator() = default;
CvodeIntegrator::CvodeIntegrator(CvodeIntegrator&&) noexcept = default;
CvodeIntegrator& CvodeIntegrator::operator=(CvodeIntegrator&&) noexcept = default;

Arrival CvodeIntegrator::advance(const ClosedLoop<double>& loop, const Phase& phase, double t0, const State<double>& x0,
                                 double t_end, StepObserver* observer, Exertion* exertion) {
  solver_->user = {loop, phase};
  if (exertion == nullptr) return solver_->advance(t0, x0, t_end, observer, nullptr);
  ExertionMeter meter(loop, phase, t0, *exertion);
  return solver_->advance(t0, x0, t_end, observer, &meter);
}

}  // namespace steerstat
