#include "service/live_outcomes.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <vector>

namespace steerstat {
namespace {

/// Takes what it is given, or nothing.
class Keeper final : public OutcomeSink {
 public:
  void take(std::uint64_t /*begin*/, std::span<const TrialOutcome> outcomes) override {
    if (is_full) throw std::runtime_error("full");
    kept += outcomes.size();
  }
  bool is_full{false};
  std::size_t kept{0};
};

/// How many trials a reader sees; nothing where it cannot look.
std::optional<std::size_t> seen(const LiveOutcomes& live) {
  std::optional<std::size_t> count;
  live.read([&](std::span<const TrialOutcome> outcomes) { count = outcomes.size(); });
  return count;
}

void take(LiveOutcomes& live, const std::vector<TrialOutcome>& slots, std::uint64_t begin, std::uint64_t end) {
  live.take(begin, std::span(slots).subspan(begin, end - begin));
}

TEST(LiveOutcomes, ShowsWhatIsFinishedUpToTheFirstGap) {
  const std::vector<TrialOutcome> slots(500);
  Keeper keeper;
  LiveOutcomes live(keeper, {{0, 100}, {200, 300}, {350, 360}});
  EXPECT_EQ(seen(live), std::nullopt) << "before the run";
  live.open(slots);
  EXPECT_EQ(seen(live), 100U);
  EXPECT_EQ(live.kept(), 210U);
  take(live, slots, 100, 150);
  EXPECT_EQ(seen(live), 150U);
  take(live, slots, 150, 200);
  EXPECT_EQ(seen(live), 300U) << "and what was known behind the gap";
  take(live, slots, 300, 350);
  EXPECT_EQ(seen(live), 360U);
  take(live, slots, 360, 500);
  EXPECT_EQ(seen(live), 500U);
  EXPECT_EQ(live.kept(), 500U);
  live.close();
  EXPECT_EQ(seen(live), std::nullopt) << "after the run";
  live.open(std::span(slots).first(420));
  EXPECT_EQ(seen(live), 420U) << "a study that stopped on precision leaves fewer";
}

TEST(LiveOutcomes, ShowsNothingThatIsNotKept) {
  const std::vector<TrialOutcome> slots(100);
  Keeper keeper;
  LiveOutcomes live(keeper, {});
  live.open(slots);
  keeper.is_full = true;
  EXPECT_THROW(take(live, slots, 0, 50), std::runtime_error);
  EXPECT_EQ(seen(live), 0U);
  EXPECT_EQ(live.kept(), 0U);
}

}  // namespace
}  // namespace steerstat
