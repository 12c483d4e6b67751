#include "study/continuation.hpp"

#include "study/spec_json.hpp"

namespace steerstat {
namespace {

/// Whether the first draws stay as they are when there are more of them. Those of a hypercube do not: its strata depend
/// on their number. Nor do a subset simulation's, whose chains begin where a level's states say; and a list of explicit
/// trials is its own length.
bool keeps_its_draws(SamplingMethod method) {
  return draws(method) && method != SamplingMethod::latin_hypercube && method != SamplingMethod::subset_simulation;
}

Study with_draws(Study study, std::uint64_t draws) {
  if (keeps_its_draws(study.sampling.method)) study.sampling.trials = draws;
  return study;
}

}  // namespace

bool continues(const Study& later, const Study& earlier) {
  return later.sampling.trials >= earlier.sampling.trials &&
         canonical_spec(with_draws(earlier, later.sampling.trials)) == canonical_spec(later);
}

std::string trials_sha256(const Study& study) {
  return spec_sha256(with_draws(study, 1));
}

}  // namespace steerstat
