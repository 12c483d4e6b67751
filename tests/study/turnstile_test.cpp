#include "study/turnstile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using std::chrono::milliseconds;

/// Waits for something that another thread is about to do.
void wait_until(const std::function<bool()>& passes) {
  while (!passes()) std::this_thread::sleep_for(milliseconds(1));
}

TEST(Turnstile, LetsAsManyWorkAtOnceAsItHasPermits) {
  for (const int permits : {1, 3}) {
    Turnstile turnstile(static_cast<unsigned>(permits), milliseconds(0));
    std::atomic<int> working{0};
    std::atomic<int> most{0};
    std::vector<std::thread> workers;
    for (int worker = 0; worker < 6; ++worker) {
      workers.emplace_back([&] {
        for (int round = 0; round < 20; ++round) {
          const Turnstile::Turn turn(&turnstile);
          const int now = ++working;
          int seen = most;
          while (seen < now && !most.compare_exchange_weak(seen, now)) {
          }
          std::this_thread::sleep_for(std::chrono::microseconds(200));
          --working;
        }
      });
    }
    for (std::thread& worker : workers) worker.join();
    EXPECT_EQ(most, permits);
  }
}

TEST(Turnstile, GivesWayToWhoWaitsOnceTheQuantumIsUsedUp) {
  Turnstile turnstile(1, milliseconds(30));
  std::vector<int> order;  // guarded by the only permit
  std::atomic<bool> came{false};
  std::thread other;
  {
    Turnstile::Turn turn(&turnstile);
    turn.give_way();  // nobody waits
    other = std::thread([&] {
      came = true;
      const Turnstile::Turn turn_of_other(&turnstile);
      order.push_back(2);
    });
    wait_until([&] { return came.load(); });
    order.push_back(1);
    const auto start = std::chrono::steady_clock::now();
    while (order.size() == 1) {
      turn.give_way();
      if (order.size() == 1) std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(20)) << "a turn lasts its quantum";
    order.push_back(3);
  }
  other.join();
  EXPECT_THAT(order, ::testing::ElementsAre(1, 2, 3));
}

TEST(Turnstile, ServesThoseWhoWaitInTheOrderOfComing) {
  Turnstile turnstile(1);
  std::vector<int> order;
  std::vector<std::thread> workers;
  {
    const Turnstile::Turn turn(&turnstile);
    for (int worker = 0; worker < 5; ++worker) {
      std::atomic<bool> comes{false};
      workers.emplace_back([&, worker] {
        comes = true;
        const Turnstile::Turn own(&turnstile);
        order.push_back(worker);
      });
      wait_until([&] { return comes.load(); });
      std::this_thread::sleep_for(milliseconds(20));  // until it stands in line
    }
  }
  for (std::thread& worker : workers) worker.join();
  EXPECT_THAT(order, ::testing::ElementsAre(0, 1, 2, 3, 4));
}

TEST(Turnstile, CostsNothingWhereThereIsNone) {
  Turnstile::Turn turn(nullptr);
  turn.give_way();
}

TEST(SharedRun, IsTheSameBitsAsOneThatHasTheProcessorsToItself) {
  const Study study = decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 20,
      "retain": {"trajectories": {"first": 2}}, "audit": {"trials": 3}, "sampling": {"trials": 2000}})",
                                   {});
  const StudyResult alone = run_study(study, {});
  const SharedWorkers workers(6);
  Turnstile turnstile(2, milliseconds(0));  // gives way at every block
  std::vector<StudyResult> results(3);
  std::vector<std::thread> runs;
  for (StudyResult& result : results) {
    runs.emplace_back([&] {
      RunOptions options;
      options.threads = 2;
      options.turns = &turnstile;
      result = run_study(study, options);
    });
  }
  for (std::thread& run : runs) run.join();
  for (const StudyResult& result : results) {
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(result.trials.outcomes, alone.trials.outcomes);
    EXPECT_EQ(result.trajectories.size(), alone.trajectories.size());
    EXPECT_EQ(result.audit.trials.size(), alone.audit.trials.size());
  }
}

/// Looks at the outcomes while a run goes on, and at its end.
class LookingSink final : public OutcomeSink {
 public:
  void open(std::span<const TrialOutcome> slots) override {
    slots_ = slots;
    ++opened;
  }
  void close() noexcept override {
    slots_ = {};
    ++closed;
  }
  void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) override {
    ASSERT_EQ(opened, closed + 1) << "what is taken can be looked at";
    EXPECT_EQ(outcomes.data(), slots_.data() + begin);
  }
  int opened{0};
  int closed{0};

 private:
  std::span<const TrialOutcome> slots_{};
};

TEST(Sink, IsShownTheSlotsOfAllTrialsUntilTheRunIsOver) {
  const Study study = decode_study(R"({"horizon": 10, "sampling": {"trials": 500}})", {});
  LookingSink sink;
  RunOptions options;
  options.sink = &sink;
  run_study(study, options);
  EXPECT_EQ(sink.opened, 2) << "once for the trials and once for the audit";
  EXPECT_EQ(sink.closed, 2);
  options.make_runner = [](const IntegratorChoice&) -> std::unique_ptr<TrialRunner> { throw std::runtime_error("no"); };
  EXPECT_THROW(run_study(study, options), std::runtime_error);
  EXPECT_EQ(sink.closed, 3) << "also at the end of a run that fails";
}

}  // namespace
}  // namespace steerstat
