#pragma once

#include <memory>
#include <utility>

#include "peer.hpp"
#include "trial/course.hpp"
#include "trial/runner.hpp"

namespace steerstat::bench {

/// Runs trials one after another on a peer, under the same supervisor as every engine.
class PeerRunner final : public TrialRunner {
 public:
  explicit PeerRunner(std::unique_ptr<Peer> peer) : peer_(std::move(peer)) {}

  using TrialRunner::run;
  void run(TrialStream& stream) override {
    std::uint64_t index = 0;
    TrialParameters parameters;
    while (stream.next(index, parameters)) {
      const ClosedLoop<double> loop = closed_loop_of(parameters);
      stream.finished(index, run_course(parameters, Exertion{},
                                        [&](const Phase& phase, double t, const State<double>& x, double t_end) {
                                          return peer_->advance(loop, phase, t, x, t_end);
                                        }));
    }
  }

 private:
  std::unique_ptr<Peer> peer_;
};

}  // namespace steerstat::bench
