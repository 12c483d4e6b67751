// The benchmarks' program; tests/bench/run builds and calls it.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy.hpp"
#include "contest.hpp"
#include "instructions.hpp"
#include "machine.hpp"
#include "peer_runner.hpp"
#include "report/text_table.hpp"
#include "trial/cvode_runner.hpp"

namespace steerstat::bench {
namespace {

constexpr double wanted_error = 1e-7;  // [s] median in settling time, what all are made to achieve
constexpr double finest = 1e-13;       // tolerance of the references

/// How long to measure.
struct Effort {
  std::uint64_t reference_trials;
  double seconds;  // of one repetition
  int repetitions;
};
constexpr Effort thorough{400, 0.7, 5};
constexpr Effort quick{100, 0.1, 1};

using Method = std::function<MakeRunner(double tolerance)>;

/// @param metrics  whether effort and peaks are measured, which the peers do not
Method lockstep_on(InstructionSet set, bool metrics = false) {
  return [=](double tolerance) -> MakeRunner {
    return [=] { return make_runner({IntegratorChoice::Method::lockstep, tolerance, metrics}, set); };
  };
}

Method peer(std::unique_ptr<Peer> (*make)(double)) {
  return
      [make](double tolerance) -> MakeRunner { return [=] { return std::make_unique<PeerRunner>(make(tolerance)); }; };
}

Method cvode() {
  return [](double tolerance) -> MakeRunner { return [=] { return std::make_unique<CvodeRunner>(tolerance, false); }; };
}

struct Named {
  std::string name;
  Method method;
};

const std::vector<Named>& peers() {
  static const std::vector<Named> all{{"SUNDIALS CVODE Adams", cvode()},
                                      {"Boost.odeint fehlberg78", peer(make_fehlberg78)},
                                      {"Boost.odeint dopri5, dense", peer(make_dopri5)},
                                      {"GSL rk8pd", peer(make_rk8pd)}};
  return all;
}

std::vector<InstructionSet> sets_here() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::portable}) {
    if (supports(set)) sets.push_back(set);
  }
  return sets;
}

void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

/// The references' outcomes: SUNDIALS' at the finest tolerance, after showing how others' are from them.
std::vector<TrialOutcome> make_reference(const Effort& effort) {
  print(fmt::format("\nReference: SUNDIALS at {:.0e}, {} trials; how far others are from it at their finest\n", finest,
                    effort.reference_trials));
  const std::vector<TrialOutcome> reference = run_trials(effort.reference_trials, cvode()(finest)).outcomes;
  std::vector<Named> others{{"lockstep", lockstep_on(best_instruction_set())}};
  others.insert(others.end(), peers().begin() + 1, peers().end());
  TextTable table({{"", TextTable::Align::left}, {"tolerance"}, {"settling error [s]"}, {"agree"}});
  for (const auto& [name, method] : others) {
    const Accuracy a = accuracy_of(run_trials(effort.reference_trials, method(finest)).outcomes, reference);
    table.add_row({{name},
                   {fmt::format("{:.0e}", finest)},
                   {fmt::format("{:.1e}", a.settling_error)},
                   {fmt::format("{}/{}", a.agreeing, a.trials)}});
  }
  print(table.text(false));
  return reference;
}

std::vector<Contender> contenders(const std::vector<TrialOutcome>& reference, const Effort& effort) {
  std::vector<Contender> all;
  const auto add = [&](const std::string& name, double tolerance, const MakeRunner& make, unsigned most_threads,
                       const Accuracy& accuracy) {
    for (unsigned threads = 1; threads <= most_threads; ++threads) {
      all.push_back({name, tolerance, make, threads, accuracy, trials_for(effort.seconds, make, threads)});
    }
  };
  // The bits are the same on every set, and so is the tolerance.
  const Calibrated best = calibrate(lockstep_on(best_instruction_set()), reference, wanted_error);
  const double standard = IntegratorChoice{}.tolerance;
  for (const InstructionSet set : sets_here()) {
    const std::string name = fmt::format("lockstep {}", name_of(set));
    const MakeRunner at_default = lockstep_on(set)(standard);
    add(name, best.tolerance, lockstep_on(set)(best.tolerance), 2, best.accuracy);
    const Accuracy accuracy = accuracy_of(run_trials(reference.size(), at_default).outcomes, reference);
    add(name, standard, at_default, 2, accuracy);
    add(name + ", metrics", standard, lockstep_on(set, true)(standard), 1, accuracy);
  }
  for (const auto& [name, method] : peers()) {
    const Calibrated calibrated = calibrate(method, reference, wanted_error);
    add(name, calibrated.tolerance, method(calibrated.tolerance), 1, calibrated.accuracy);
  }
  return all;
}

void print_contest(const std::vector<TrialOutcome>& reference, const Effort& effort) {
  const std::vector<Contender> all = contenders(reference, effort);
  const std::vector<Rate> rates = measure_rates(all, effort.repetitions);
  print(
      fmt::format("\nTrials a second: medians of {} repetitions in turns. \"Slower\": how many times lockstep's rate on"
                  "\none thread, {}, at the same error, is that of the line, by CPU time.\n",
                  effort.repetitions, name_of(best_instruction_set())));
  TextTable table({{"", TextTable::Align::left},
                   {"tolerance"},
                   {"settling error [s]"},
                   {"agree"},
                   {"threads"},
                   {"trials/s"},
                   {"trials/CPU s"},
                   {"slower"},
                   {"two threads / one"}});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Contender& c = all[i];
    table.add_row({{c.name},
                   {fmt::format("{:.1e}", c.tolerance)},
                   {fmt::format("{:.1e}", c.accuracy.settling_error)},
                   {fmt::format("{}/{}", c.accuracy.agreeing, c.accuracy.trials)},
                   {fmt::format("{}", c.threads)},
                   {fmt::format("{:.0f}", rates[i].by_wall)},
                   {fmt::format("{:.0f}", rates[i].by_cpu)},
                   {fmt::format("{:.2f}", rates[0].by_cpu / rates[i].by_cpu)},
                   {c.threads == 2 ? fmt::format("{:.3f}", rates[i].by_wall / rates[i - 1].by_wall) : ""}});
  }
  print(table.text(false));
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

void print_anatomy(const Effort& effort) {
  const double tolerance = IntegratorChoice{}.tolerance;
  std::vector<TextTable::Column> columns{{"", TextTable::Align::left}};
  std::vector<Anatomy> parts;
  std::vector<std::optional<FmaPeak>> peaks;
  for (const InstructionSet set : sets_here()) {
    columns.push_back({std::string(name_of(set))});
    peaks.push_back(measure_fma_peak(set));
    parts.push_back(dissect_lockstep(set, tolerance, effort.seconds, effort.repetitions));
  }
  TextTable table(columns);
  const auto add = [&](const std::string& title, auto&& text) {
    std::vector<TextTable::Cell> cells{{title}};
    for (std::size_t i = 0; i < parts.size(); ++i) cells.push_back({text(parts[i], peaks[i])});
    table.add_row(cells);
  };
  using Peak = std::optional<FmaPeak>;
  const auto series_share = [](const Anatomy& a) { return a.shares[static_cast<std::size_t>(Part::series)]; };
  add("lane-steps a trial",
      [](const Anatomy& a, const Peak&) { return fmt::format("{:.1f}", a.lane_steps_per_trial); });
  add("phase ends a trial", [](const Anatomy& a, const Peak&) { return fmt::format("{:.2f}", a.arrivals_per_trial); });
  add("guard searches a trial",
      [](const Anatomy& a, const Peak&) { return fmt::format("{:.2f}", a.searches_per_trial); });
  add("lane occupancy", [](const Anatomy& a, const Peak&) { return fmt::format("{:.5f}", a.occupancy); });
  add("ns a lane-step, all work",
      [](const Anatomy& a, const Peak&) { return fmt::format("{:.2f}", a.ns_per_lane_step); });
  add("operations a lane-step, double + single", [](const Anatomy& a, const Peak&) {
    return fmt::format("{} + {}", a.operations.step.in_double, a.operations.step.in_single);
  });
  add("of these in the series", [](const Anatomy& a, const Peak&) {
    return fmt::format("{} + {}", a.operations.series.in_double, a.operations.series.in_single);
  });
  add("FMA peak, double; single [GFLOP/s]", [](const Anatomy&, const Peak& p) {
    return p ? fmt::format("{:.1f}; {:.1f}", 1e-9 * p->in_double, 1e-9 * p->in_single) : "-";
  });
  add("share of the peak, all work", [](const Anatomy& a, const Peak& p) {
    return p ? percent(share_of_peak(a.operations.step, a.ns_per_lane_step, *p)) : "-";
  });
  add("share of the peak inside the series", [&](const Anatomy& a, const Peak& p) {
    return p ? percent(share_of_peak(a.operations.series, a.ns_per_lane_step * series_share(a), *p)) : "-";
  });
  for (std::size_t part = 0; part < part_names.size(); ++part) {
    add("time: " + std::string(part_names[part]),
        [part](const Anatomy& a, const Peak&) { return percent(a.shares[part]); });
  }
  add("samples of time", [](const Anatomy& a, const Peak&) { return fmt::format("{}", a.samples); });
  print(fmt::format(
      "\nThe lockstep runner at {:.0e}, one thread. Operations: a fused multiply-add is two, a sum, product or quotient"
      "\none. Shares of time: a sample a millisecond, by function; what is inlined counts for its caller.\n",
      tolerance));
  print(table.text(false));
  print(fmt::format("\nIts functions on {}\n", name_of(sets_here().front())));
  const std::vector<Anatomy::Function>& functions = parts.front().functions;
  for (std::size_t i = 0; i < std::min<std::size_t>(12, functions.size()); ++i) {
    print(fmt::format("  {:>6}  {}\n", percent(functions[i].share), functions[i].name.substr(0, 130)));
  }
}

void print_all(const Effort& effort) {
  print(description_of_machine());
  print_anatomy(effort);
  print_contest(make_reference(effort), effort);
}

}  // namespace
}  // namespace steerstat::bench

int main(int argc, char** argv) {
  try {
    if (argc == 2 && std::string_view(argv[1]) == "instructions") {
      steerstat::bench::run_to_be_counted();
    } else if (argc == 2 && std::string_view(argv[1]) == "machine") {
      std::fputs(steerstat::bench::description_of_machine().c_str(), stdout);
    } else if (argc == 2 && std::string_view(argv[1]) == "quick") {
      steerstat::bench::print_all(steerstat::bench::quick);
    } else if (argc == 1) {
      steerstat::bench::print_all(steerstat::bench::thorough);
    } else {
      std::fputs("usage: steerstat_bench [quick | instructions | machine]\n", stderr);
      return 2;
    }
  } catch (const std::exception& failure) {
    fmt::print(stderr, "steerstat_bench: {}\n", failure.what());
    return 1;
  }
  return 0;
}
