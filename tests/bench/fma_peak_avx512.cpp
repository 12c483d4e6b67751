#define BENCH_ISA avx512
#define BENCH_DOUBLES 8
#define BENCH_SINGLES 16
#include "fma_chains.hpp"
