#include "study/store_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "study/limits.hpp"
#include "study/rate.hpp"

namespace steerstat {
namespace {

std::uint64_t cell_count(const Study& study) {
  double cells = 1.0;
  for (const Input& input : study.inputs) {
    if (const auto* sweep = std::get_if<Sweep>(&input.value)) cells *= static_cast<double>(sweep->values.size());
  }
  return cells > static_cast<double>(most_cells) ? most_cells : static_cast<std::uint64_t>(cells);
}

/// Whether a gate over all cells needs the sums of each draw: an interval does, an extreme or a number does not.
bool needs_draws(const Gate& gate) {
  if (gate.each_cell || !gate.cell.empty() || outcome_of_rate(gate.metric)) return false;
  const Quantity quantity = gate.expression.quantity;
  return quantity != Quantity::min && quantity != Quantity::max && quantity != Quantity::count;
}

}  // namespace

void check_store(const Study& study, const std::vector<std::string>& mistaken, std::vector<SpecError>& errors) {
  if (study.store == Store::all) return;
  const auto is_mistaken = [&](const char* name) {
    return std::find(mistaken.begin(), mistaken.end(), name) != mistaken.end();
  };
  const std::string_view store = store_names[static_cast<std::size_t>(study.store)];
  const auto refuse = [&](std::string pointer, const std::string& detail) {
    errors.push_back({std::move(pointer), detail});
  };
  if (!is_mistaken("sampling") && study.sampling.method == SamplingMethod::sobol_indices) {
    refuse("/store", fmt::format("\"{}\" with the method sobol_indices (its indices are of all trials of a row "
                                 "together); store \"all\", or use another method",
                                 store));
  }
  if (!is_mistaken("sampling") && seeks_failures(study.sampling.method)) {
    refuse("/store", fmt::format("\"{}\" with the method {} (its trials are weighed one by one); store \"all\", or use "
                                 "another method",
                                 store, sampling_method_names[static_cast<std::size_t>(study.sampling.method)]));
  }
  if (study.stop && !is_mistaken("stop")) {
    for (std::size_t i = 0; i < study.stop->until.size(); ++i) {
      if (!study.stop->until[i].quantile) continue;
      refuse(fmt::format("/stop/until/{}", i),
             fmt::format("the precision of a quantile beside \"store\": \"{}\" (where it stops must not depend on a "
                         "sketch); store \"all\", or ask for a rate",
                         store));
    }
  }
  const std::uint64_t cells = cell_count(study);
  if (cells > most_sketched_cells) {
    refuse("/store",
           fmt::format("\"{}\" with {} cells (at most {}, a sketch of each being in memory); store \"all\", or "
                       "shorten the sweeps",
                       store, cells, most_sketched_cells));
  }
  for (std::size_t i = 0; i < study.gates.size() && cells > 1; ++i) {
    if (!needs_draws(study.gates[i])) continue;
    refuse(
        fmt::format("/gates/{}", i),
        fmt::format("a gate on {} over all cells beside \"store\": \"{}\" (cells share their draws, whose trials its "
                    "interval needs together); add \"scope\": \"each_cell\", or store \"all\"",
                    study.gates[i].metric, store));
  }
  if (study.audited_trials > most_sketched_audit) {
    refuse("/audit/trials", fmt::format("{} audited trials beside \"store\": \"{}\" (at most {}, whose rows are kept); "
                                        "lower it, or store \"all\"",
                                        study.audited_trials, store, most_sketched_audit));
  }
}

}  // namespace steerstat
