#pragma once

#include "store/hdf5.hpp"
#include "study/trial_sketch.hpp"

/// A sketch of trials in the group /sketch of a result file or a part (schemas/result_file.md).
namespace steerstat::hdf5 {

/// @param sketch  the same one gives the same bytes, whatever it was added up of
void write_sketch(hid_t file, const TrialSketch& sketch);

/// @param cells   of the study
/// @param trials  of the study
/// @throws Problem where it is not one of such a study
TrialSketch read_sketch(hid_t file, std::uint64_t cells, std::uint64_t trials);

}  // namespace steerstat::hdf5
