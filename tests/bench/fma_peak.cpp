#include "fma_peak.hpp"

#include <algorithm>

#include "clocks.hpp"

namespace steerstat::bench {

namespace avx512 {
double run_double_chains(double& sink);
double run_single_chains(double& sink);
}  // namespace avx512
namespace avx2 {
double run_double_chains(double& sink);
double run_single_chains(double& sink);
}  // namespace avx2

namespace {

double best_rate(double (*run)(double&)) {
  constexpr int attempts = 25;
  double best = 0.0;
  double sink = 1.0;
  for (int i = 0; i < attempts; ++i) {
    double operations = 0.0;
    const Duration duration = time_of([&] { operations = run(sink); });
    best = std::max(best, operations / duration.cpu);
  }
  return best;
}

}  // namespace

std::optional<FmaPeak> measure_fma_peak(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return FmaPeak{best_rate(avx512::run_double_chains), best_rate(avx512::run_single_chains)};
    case InstructionSet::avx2:
      return FmaPeak{best_rate(avx2::run_double_chains), best_rate(avx2::run_single_chains)};
    case InstructionSet::portable:
      break;
  }
  return std::nullopt;
}

}  // namespace steerstat::bench
