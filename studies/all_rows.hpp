#pragma once

#include <string>

#include "store/result_file.hpp"

namespace steerstat {

/// @param file  where the study was read from
/// @param what  that needs the rows of all its trials, such as "a comparison"
/// @throws BadUsage where it does not have them
void require_all_rows(const StoredStudy& stored, const std::string& file, const std::string& what);

}  // namespace steerstat
