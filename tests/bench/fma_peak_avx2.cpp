#define BENCH_ISA avx2
#define BENCH_DOUBLES 4
#define BENCH_SINGLES 8
#include "fma_chains.hpp"
