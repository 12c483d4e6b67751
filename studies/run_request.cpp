#include "run_request.hpp"

#include <fmt/format.h>

#include <vector>

#include "core/errors.hpp"
#include "output.hpp"
#include "report/readable.hpp"

namespace steerstat {

void check_outputs(const RunRequest& request) {
  if (request.resume && !request.result) {
    throw BadUsage(
        "--resume: without -o no trials are kept to go on with; name the result file of the interrupted run");
  }
  if (request.result == "-") {
    throw BadUsage("-o: a result file cannot go to standard output (HDF5 is not a stream); name a file");
  }
  std::vector<NamedFile> outputs = request.report.outputs();
  if (request.result) outputs.insert(outputs.begin(), {"-o", *request.result});
  std::vector<NamedFile> inputs{{"the spec", request.spec}};
  if (request.report.baseline) inputs.push_back({"the baseline", *request.report.baseline});
  check_outputs(outputs, inputs);
}

std::optional<StudyShare> share_of(const RunRequest& request) {
  if (!request.shard) return std::nullopt;
  const std::optional<StudyShare> share = parse_share(*request.shard);
  if (!share) {
    throw BadUsage(fmt::format("--shard: '{}' is no shard (I/N, with I from 1 to N, and N at most {}); try 1/4",
                               printable(*request.shard), readable_count(most_shares)));
  }
  if (!request.result) throw BadUsage("--shard: without -o its trials are not kept to be merged; name a file");
  if (request.report.baseline || !request.report.files.named().empty()) {
    throw BadUsage("--baseline, --junit and --markdown are of a whole study, not of a shard; give them to merge");
  }
  return share;
}

void require_together(const Study& study, const RunRequest& request, const Ranks* ranks) {
  if (study.store == Store::all || !study.stop || (!request.shard && ranks == nullptr)) return;
  throw BadUsage(fmt::format(
      "{}: the spec has a \"stop\" and does not store all rows (a sketch of trials beyond the stop cannot be cut where "
      "it stops); remove \"stop\", store \"all\", or run it in one process",
      request.shard ? "--shard" : "several ranks"));
}

std::optional<Baseline> read_baseline(const RunRequest& request, const Study& study) {
  if (request.report.baseline == "-" && request.spec == "-") {
    throw BadUsage("the spec and --baseline cannot both come from standard input; name a file for one of them");
  }
  return request.report.read_baseline(study);
}

}  // namespace steerstat
