#include "study/unmeasured_json.hpp"

#include <fmt/format.h>

#include "trial/metric.hpp"

namespace steerstat {

void refuse_unmeasured(const Reader& reader, std::string_view name) {
  const Metric* metric = find_metric(name);
  if (metric == nullptr || !metric->optional) return;
  reader.fail(
      fmt::format("{} is not measured (\"metrics\" is false); leave \"metrics\" out, or ask for another metric", name));
}

}  // namespace steerstat
