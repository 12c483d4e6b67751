#pragma once

#include "study/reader_json.hpp"
#include "trial/runner.hpp"

namespace steerstat {

/// Decodes a spec's `integrator`. @param integrator  what the spec does not say, or says mistakenly, stays
void decode_integrator(const Reader& reader, IntegratorChoice& integrator);

}  // namespace steerstat
