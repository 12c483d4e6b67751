#include "baseline_file.hpp"

#include "core/errors.hpp"
#include "text_input.hpp"

namespace steerstat {

Baseline read_baseline_file(const std::string& name) {
  const std::string text = read_text(name, "a summary", "give what `run --summary` wrote");
  try {
    return read_baseline(text);
  } catch (const BadSpec& bad) {
    std::string message = "--baseline: " + (name == "-" ? "standard input" : name) +
                          " is not the summary of a study to compare with; give what `run --summary` wrote";
    for (const SpecError& error : bad.errors()) {
      message += '\n';
      if (!error.pointer.empty()) message += error.pointer + ": ";
      message += error.detail;
    }
    throw BadUsage(message);
  }
}

}  // namespace steerstat
