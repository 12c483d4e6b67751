#pragma once

#include <string>

#include "store/result_file.hpp"
#include "trial/replay.hpp"

namespace steerstat {

/// A trajectory as CSV: t,q1,q2,q1_dot,q2_dot,a,tau,phase; numbers read back to the same bits.
std::string trajectory_csv(const Trajectory& trajectory);

/// A result file's trials as CSV, a row a trial: index, cell, what varied (by dotted name), then how it ended. Numbers
/// read back to the same bits; the settling time of a trial that did not settle is left empty.
std::string trials_csv(const StoredStudy& stored);

}  // namespace steerstat
