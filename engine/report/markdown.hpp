#pragma once

#include <string>

#include "report/summary.hpp"

namespace steerstat {

/// The summary as GitHub-flavoured Markdown, fit for a job summary: the verdicts first, then the success rate with its
/// interval, the outcomes and the metrics. The study's name shows as it is, whatever characters it has.
std::string summary_markdown(const Summary& summary);

}  // namespace steerstat
