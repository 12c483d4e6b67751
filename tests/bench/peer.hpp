#pragma once

#include <functional>
#include <memory>
#include <string>

#include "control/phase.hpp"
#include "integrate/arrival.hpp"
#include "integrate/closed_loop.hpp"

namespace steerstat::bench {

/// An integrator that others wrote, made to run the phases of a trial. Not thread-safe.
///
/// Sources of peers are compiled for this very machine with all its instructions (see CMakeLists.txt); this header and
/// what it includes must therefore define no function that the engine uses too.
class Peer {
 public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  /// Advances the closed loop through one phase, to t_end or to the first guard of `phase` that fires, dips within a
  /// step included. @param t0, t_end  [s], t0 < t_end
  virtual Arrival advance(const ClosedLoop<double>& loop, const Phase& phase, double t0, const State<double>& x0,
                          double t_end) = 0;
};

/// Boost.odeint's runge_kutta_fehlberg78, its own step control, guards found as SteppedGuards says.
std::unique_ptr<Peer> make_fehlberg78(double tolerance);
/// Boost.odeint's runge_kutta_dopri5, guards found on its dense output.
std::unique_ptr<Peer> make_dopri5(double tolerance);
/// GSL's rk8pd, its own step control, guards found as SteppedGuards says.
std::unique_ptr<Peer> make_rk8pd(double tolerance);

/// What the sources of peers are compiled with beyond the flags of all.
std::string peer_flags();

}  // namespace steerstat::bench
