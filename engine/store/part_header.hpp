#pragma once

#include "store/hdf5.hpp"
#include "store/shard.hpp"

/// What every part of a study begins with (schemas/result_file.md).
namespace steerstat::hdf5 {

/// @param wall_s  [s] that the run took for its trials
void write_part_header(hid_t file, const ShardOrigin& origin, double wall_s);

/// @return wall_s @throws Problem where it is no part, or of another origin
double read_part_header(hid_t file, const ShardOrigin& origin);

}  // namespace steerstat::hdf5
