#include "statistics/proportion_drop.hpp"

#include <cmath>
#include <stdexcept>

#include "statistics/proportion.hpp"

namespace steerstat {

ProportionDrop proportion_drop(const ProportionCount& before, const ProportionCount& after, double level) {
  if (!(level > 0.0 && level < 0.5)) throw std::invalid_argument("proportion_drop: needs a level in (0, 0.5)");
  const auto limits = [&](const ProportionCount& count) {
    return clopper_pearson_interval(count.successes, count.trials, 1.0 - 2.0 * level);
  };
  const ProportionInterval p0 = limits(before);
  const ProportionInterval p1 = limits(after);
  const double drop = p0.estimate - p1.estimate;
  return {drop, drop - std::hypot(p0.estimate - p0.low, p1.high - p1.estimate),
          drop + std::hypot(p0.high - p0.estimate, p1.estimate - p1.low)};
}

std::optional<double> detectable_drop(const ProportionCount& before, std::uint64_t trials, double level, double power) {
  if (trials == 0) throw std::invalid_argument("detectable_drop: needs trials");
  if (!(power > 0.5 && power < 1.0)) throw std::invalid_argument("detectable_drop: needs a power in (0.5, 1)");
  const auto shows_drop = [&](std::uint64_t successes) {
    return proportion_drop(before, {successes, trials}, level).low > 0.0;
  };
  if (!shows_drop(0)) return std::nullopt;
  std::uint64_t most = 0;        // successes that show a drop
  std::uint64_t least = trials;  // successes that do not: as many as trials is no drop at all
  while (least - most > 1) {
    const std::uint64_t middle = most + (least - most) / 2;
    (shows_drop(middle) ? most : least) = middle;
  }
  // The proportion p with P(X <= most) = power, that is P(X >= most + 1) = 1 - power: a lower Clopper-Pearson limit.
  const double p = clopper_pearson_interval(most + 1, trials, 2.0 * power - 1.0).low;
  return static_cast<double>(before.successes) / static_cast<double>(before.trials) - p;
}

}  // namespace steerstat
