#include "contest.hpp"

#include <algorithm>

namespace steerstat::bench {

std::vector<Rate> measure_rates(const std::vector<Contender>& contenders, int repetitions) {
  std::vector<std::vector<double>> by_wall(contenders.size());
  std::vector<std::vector<double>> by_cpu(contenders.size());
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const Contender& contender = contenders[i];
      const Duration duration = run_trials(contender.trials, contender.make_runner, contender.threads).duration;
      by_wall[i].push_back(static_cast<double>(contender.trials) / duration.wall);
      by_cpu[i].push_back(static_cast<double>(contender.trials) / duration.cpu);
    }
  }
  std::vector<Rate> rates;
  for (std::size_t i = 0; i < contenders.size(); ++i) rates.push_back({median(by_wall[i]), median(by_cpu[i])});
  return rates;
}

std::uint64_t trials_for(double seconds, const MakeRunner& make_runner, unsigned threads) {
  // A few trials first: then as many as fill the lanes of those that are quick.
  double trials = 100.0;
  for (int i = 0; i < 2; ++i) {
    const Duration duration = run_trials(static_cast<std::uint64_t>(trials), make_runner, 1).duration;
    trials = std::max(100.0, trials / duration.cpu * (i == 0 ? 0.2 : seconds * threads));
  }
  return static_cast<std::uint64_t>(trials);
}

}  // namespace steerstat::bench
