#pragma once

#include <string>

#include "service/study_rows.hpp"
#include "service/study_service.hpp"

namespace steerstat {

// What the API says, as JSON (schemas/openapi.yaml). Numbers read back to the same bits; what is not finite is null.
// Each ends in a newline but state_json(), which is one line of an event too.

std::string state_json(const StudyState& state);
std::string page_json(const StudyPage& page);
std::string trials_json(const TrialPage& page);
/// The page's one trial.
std::string trial_json(const TrialPage& page);

}  // namespace steerstat
