// Chains of fused multiply-adds. Included once by a source that defines BENCH_ISA, BENCH_DOUBLES and BENCH_SINGLES, the
// widths of its registers, and is compiled for that instruction set.

#include <cstdint>

namespace steerstat::bench::BENCH_ISA {
namespace {

/// As many as hide the latency of two units at four to five cycles.
constexpr int chains = 12;
constexpr std::int64_t rounds = 2'000'000;

template <class Number, int lanes>
double run_chains(double& sink) {
  typedef Number Vector __attribute__((vector_size(sizeof(Number) * lanes)));
  const Number one = static_cast<Number>(sink);  // not known when compiled
  Vector factor{}, term{};
  for (int lane = 0; lane < lanes; ++lane) {
    factor[lane] = one;
    term[lane] = one - one;
  }
  // A variable a chain: an array would stay in memory.
  Vector a = factor, b = a, c = a, d = a, e = a, f = a, g = a, h = a, i = a, j = a, k = a, l = a;
  const auto fuse = [&](Vector & x) __attribute__((always_inline)) {
    x = x * factor + term;  // contracted: this source is compiled with -ffp-contract=fast
    __asm__ volatile("" : "+v"(x));
  };
  for (std::int64_t round = 0; round < rounds; ++round) {
    fuse(a), fuse(b), fuse(c), fuse(d), fuse(e), fuse(f), fuse(g), fuse(h), fuse(i), fuse(j), fuse(k), fuse(l);
  }
  const Vector sum = a + b + c + d + e + f + g + h + i + j + k + l;
  sink += static_cast<double>(sum[0] - chains * one);
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
