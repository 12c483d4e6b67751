#include "trial/sensor.hpp"

#include <string_view>

#include "core/normal.hpp"
#include "sampling/stream.hpp"

namespace steerstat {
namespace {

double drawn(std::uint64_t seed, std::string_view name, std::uint64_t k, double standard_deviation) {
  if (standard_deviation == 0.0) return 0.0;
  return standard_deviation * normal_quantile(UniformStream(seed, name).at(k));
}

}  // namespace

State<double> Sensor::error(std::uint64_t k) const {
  return {bias.q1 + drawn(noise_seed, "sensor.noise.q1", k, noise.q1),
          bias.q2 + drawn(noise_seed, "sensor.noise.q2", k, noise.q2),
          bias.q1_dot + drawn(noise_seed, "sensor.noise.q1_dot", k, noise.q1_dot),
          bias.q2_dot + drawn(noise_seed, "sensor.noise.q2_dot", k, noise.q2_dot)};
}

}  // namespace steerstat
