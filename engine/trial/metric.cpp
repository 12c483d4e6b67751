#include "trial/metric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace steerstat {
namespace {

double finite(double x) {
  return std::isfinite(x) ? x : no_value;
}

constexpr std::array<Metric, metric_count> registry{{
    {"settling_time", "s", [](const TrialOutcome& o) { return o.settling_time(); }},
    {"cycles", "1",
     [](const TrialOutcome& o) { return o.status == Status::converged ? static_cast<double>(o.cycles) : no_value; }},
    {"effort", "N^2 s", [](const TrialOutcome& o) { return finite(o.effort); }, true},
    {"peak_acceleration", "m/s^2", [](const TrialOutcome& o) { return finite(o.peak_acceleration); }, true},
    {"peak_force", "N", [](const TrialOutcome& o) { return finite(o.peak_force); }, true},
    {"peak_stroke", "m", [](const TrialOutcome& o) { return finite(o.peak_stroke); }, true},
    {"position_contraction_mean", "1", [](const TrialOutcome& o) { return finite(o.position_contraction.mean); }},
    {"position_contraction_worst", "1", [](const TrialOutcome& o) { return finite(o.position_contraction.worst); }},
    {"velocity_contraction_mean", "1", [](const TrialOutcome& o) { return finite(o.velocity_contraction.mean); }},
    {"velocity_contraction_worst", "1", [](const TrialOutcome& o) { return finite(o.velocity_contraction.worst); }},
}};

}  // namespace

std::span<const Metric> metrics() {
  return registry;
}

const Metric* find_metric(std::string_view name) {
  const auto found = std::find_if(registry.begin(), registry.end(), [&](const Metric& m) { return m.name == name; });
  return found == registry.end() ? nullptr : &*found;
}

std::size_t metric_index(std::string_view name) {
  const Metric* metric = find_metric(name);
  if (metric == nullptr) throw std::invalid_argument("there is no metric " + std::string(name));
  return static_cast<std::size_t>(metric - registry.data());
}

}  // namespace steerstat
