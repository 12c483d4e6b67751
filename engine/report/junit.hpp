#pragma once

#include <string>

#include "report/summary.hpp"

namespace steerstat {

/// The gates' verdicts as JUnit XML, which continuous integration reads: a test suite named after the study, a test
/// case a gate. A gate that failed is a `failure`; one that was inconclusive is an `error`, a test that came to no
/// result: `skipped` would show green, and what is not known must not look as if it had passed.
///
/// Well-formed XML 1.0 in UTF-8 whatever the study's name is; characters that XML does not have become U+FFFD.
std::string junit_xml(const Summary& summary);

}  // namespace steerstat
