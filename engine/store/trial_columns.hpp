#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/status.hpp"
#include "store/column.hpp"
#include "trial/trial.hpp"

/// The datasets of /trials that result files and shards share: what each trial ended in.
namespace steerstat::hdf5 {

/// Writes every dataset that follows from the outcomes alone.
void write_outcomes(hid_t trials, std::span<const TrialOutcome> outcomes);

/// Whether all that write_outcomes() writes is there: not in files of programs that measured less. @throws Problem
bool has_every_outcome(hid_t trials);

/// Reads back rows of what write_outcomes() wrote, the same bits; what is missing reads as no_value. @throws Problem
std::vector<TrialOutcome> read_outcomes(hid_t trials, Rows rows);

/// Reads `status` of a group. @param place  the group's name, for messages @throws Problem
std::vector<Status> read_statuses(hid_t group, std::string_view place, Rows rows);

/// Reads `index`. @return below `trials`, rising @throws Problem
std::vector<std::uint64_t> read_index(hid_t group, std::uint64_t trials);

}  // namespace steerstat::hdf5
