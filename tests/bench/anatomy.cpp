#include "anatomy.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>

#include "contest.hpp"
#include "profile.hpp"
#include "trial/lockstep_runner.hpp"

namespace steerstat::bench {
namespace {

/// Which part a function of the program belongs to, by its name; the first that fits.
Part part_of(std::string_view name) {
  struct Rule {
    Part part;
    std::initializer_list<std::string_view> words;
  };
  static const std::array<Rule, 6> rules{
      {{Part::series, {"::expand"}},
       {Part::step, {"::advance", "::begin_step", "::choose_step", "::move<", "::watch<", "::may_reach_ceiling"}},
       {Part::guards,
        {"bracket_crossing", "refine", "::sample(", "StepMotion", "Firings", "take_lane", "::search(",
         "::note_firings("}},
       {Part::supervisor, {"steerstat::decide"}},
       {Part::runner, {"LockstepRunner", "Kernel<", "LockstepEngine"}},
       {Part::draws,
        {"Plan", "Distribution", "MonteCarlo", "LatinHypercube", "Permutation", "Sobol", "NestedScrambling",
         "CorrelatedDesign", "Factorial", "normal_"}}}};
  for (const Rule& rule : rules) {
    for (std::string_view word : rule.words) {
      if (name.find(word) != std::string_view::npos) return rule.part;
    }
  }
  return Part::other;
}

/// How many doubles the kernel expands to at this tolerance: the template argument in its function's name.
int precision_in(const Profile& profile) {
  constexpr std::string_view function = "::expand<";
  for (const auto& [name, samples] : profile) {
    const std::size_t at = name.find(function);
    if (at != std::string::npos) return std::atoi(name.c_str() + at + function.size());
  }
  return 0;
}

/// Lanes in a pack, from what one step of an engine counts.
double lanes_in_pack(InstructionSet set, double tolerance) {
  const auto engine = make_lockstep_engine(tolerance, set);
  const PlantConstants<double> plant = constants_of(PlantParameters<double>{});
  engine->seat(0, {plant, plant, 7.0, 5.0, 0.0});
  engine->start(0, Phase{PhaseKind::drift}, 0.0, State<double>{}, 1.0);
  engine->step();
  return static_cast<double>(engine->lanes()) / static_cast<double>(engine->counters().steps);
}

}  // namespace

Anatomy dissect_lockstep(InstructionSet set, double tolerance, double seconds, int repetitions) {
  const auto make_lockstep = [&] { return make_runner({IntegratorChoice::Method::lockstep, tolerance, false}, set); };
  const std::uint64_t trials = trials_for(seconds, make_lockstep, 1);
  const Plan plan(combined_study(trials));
  Anatomy anatomy{};
  std::vector<double> cpu;
  LockstepEngine::Counters counters;
  for (int i = 0; i < repetitions; ++i) {
    LockstepRunner runner(tolerance, set, false);
    PlanStream stream(plan);
    cpu.push_back(time_of([&] { runner.run(stream); }).cpu);
    counters = runner.engine().counters();
  }
  const auto lane_steps = static_cast<double>(counters.lane_steps);
  const auto per_trial = [&](std::uint64_t count) { return static_cast<double>(count) / static_cast<double>(trials); };
  anatomy.lane_steps_per_trial = per_trial(counters.lane_steps);
  anatomy.arrivals_per_trial = per_trial(counters.arrivals);
  anatomy.searches_per_trial = per_trial(counters.searches);
  anatomy.occupancy = lane_steps / (static_cast<double>(counters.steps) * lanes_in_pack(set, tolerance));
  anatomy.ns_per_lane_step = 1e9 * median(cpu) / lane_steps;

  const Profile samples = profile([&] {
    for (int i = 0; i < repetitions; ++i) {
      LockstepRunner runner(tolerance, set, false);
      PlanStream stream(plan);
      runner.run(stream);
    }
  });
  for (const auto& [name, count] : samples) anatomy.samples += count;
  for (const auto& [name, count] : samples) {
    const double share = static_cast<double>(count) / static_cast<double>(anatomy.samples);
    anatomy.shares[static_cast<std::size_t>(part_of(name))] += share;
    anatomy.functions.push_back({name, share});
  }
  std::sort(anatomy.functions.begin(), anatomy.functions.end(),
            [](const auto& a, const auto& b) { return a.share > b.share; });
  anatomy.operations = count_operations(precision_in(samples));
  return anatomy;
}

double share_of_peak(const Operations& operations, double ns, const FmaPeak& peak) {
  const double at_peak = static_cast<double>(operations.in_double) / peak.in_double +
                         static_cast<double>(operations.in_single) / peak.in_single;
  return at_peak / (1e-9 * ns);
}

}  // namespace steerstat::bench
