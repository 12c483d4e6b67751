// Included once by a source compiled for an instruction set, after its pack; see core/instruction_set.hpp.

#include "core/pack_elementary.hpp"

namespace steerstat::STEERSTAT_ISA {

void evaluate_packs(int function, const double* in, double* out, std::size_t count) {
  alignas(64) double row[Pack::lanes];
  for (std::size_t i = 0; i < count; i += Pack::lanes) {
    std::memcpy(row, in + i, sizeof row);
    const Pack x = load(row);
    Pack y(0.0);
    if (function == 0) y = sincos(x).sin;
    if (function == 1) y = sincos(x).cos;
    if (function == 2) y = coarse_log2(x);
    if (function == 3) y = coarse_exp2(x);
    if (function == 4) y = widen(narrow(x));
    if (function == 5) y = sqrt(x);
    store(row, y);
    std::memcpy(out + i, row, sizeof row);
  }
}

}  // namespace steerstat::STEERSTAT_ISA
