// Chains of fused multiply-adds. Included once by a source that defines BENCH_ISA, BENCH_DOUBLES and BENCH_SINGLES, the
// widths of its registers, and is compiled for that instruction set.

#include <cstdint>

namespace steerstat::bench::BENCH_ISA {
namespace {

/// As many as hide the latency of two units at four to five cycles.
constexpr int chains = 14;
constexpr std::int64_t rounds = 2'000'000;

template <class Number, int lanes>
double run_chains(double& sink) {
  typedef Number Vector __attribute__((vector_size(sizeof(Number) * lanes)));
  const Number one = static_cast<Number>(sink);  // not known when compiled
  Vector factor{}, term{}, sum[chains];
  for (int lane = 0; lane < lanes; ++lane) {
    factor[lane] = one;
    term[lane] = one - one;
  }
  for (Vector& s : sum) s = factor;
  for (std::int64_t i = 0; i < rounds; ++i) {
#pragma GCC unroll 16
    for (int k = 0; k < chains; ++k) {
      sum[k] = sum[k] * factor + term;  // contracted: this source is compiled with -ffp-contract=fast
      __asm__ volatile("" : "+v"(sum[k]));
    }
  }
  for (const Vector& s : sum) sink += static_cast<double>(s[0] - one);
  return 2.0 * lanes * chains * static_cast<double>(rounds);
}

}  // namespace

/// Runs the chains. @param sink  1, and still so after. @return operations done
double run_double_chains(double& sink);
double run_single_chains(double& sink);

double run_double_chains(double& sink) {
  return run_chains<double, BENCH_DOUBLES>(sink);
}
double run_single_chains(double& sink) {
  return run_chains<float, BENCH_SINGLES>(sink);
}

}  // namespace steerstat::bench::BENCH_ISA
