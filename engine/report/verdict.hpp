#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "statistics/sample_interval.hpp"
#include "study/gate.hpp"
#include "study/plan.hpp"

namespace steerstat {

enum class Verdict : std::uint8_t { pass, fail, inconclusive };
inline constexpr std::array<std::string_view, 3> verdict_names{"pass", "fail", "inconclusive"};

constexpr std::string_view name_of(Verdict verdict) {
  return verdict_names[static_cast<std::size_t>(verdict)];
}

/// What the trials say of a quantity.
struct Evidence {
  std::optional<double> value;  ///< empty without data
  SampleInterval interval;      ///< of the estimate behind it; a bound is empty where there is none (min, max, count)
  std::string_view doubt{};     ///< why the interval bears no level; empty: it bears its own
};

struct Judgement {
  Verdict verdict;
  std::string reason;  ///< one clause, without a full stop
};

/// Judges what a gate demands.
///
/// - estimate, mean, quantiles: by the interval. Pass when all of it satisfies the comparison, fail when none of it
///   does, else inconclusive. `ci_low >` and `>=`, `ci_high <` and `<=` are the same demands in other words.
/// - The other comparisons of ci_low and ci_high, and those of min, max and count, look at that number alone.
/// - Without data: inconclusive; a count has data always. So is whatever rests on an interval that bears no level.
/// - What would pass is inconclusive where trials are missing. What fails stays failed: an interval of fewer trials is
///   wider, but bears the same level, and which trials are missing does not depend on how they would have ended. Only
///   what more trials are bound to be able to mend (a minimum too large, a maximum or a count too small) is
///   inconclusive.
///
/// @param shortfall  what the study is short of, "only 20 of 100 trials have finished"; empty: nothing
Judgement judge(const GateExpression& expression, const Evidence& evidence, std::string_view shortfall);

/// How a gate came out.
struct GateVerdict {
  std::string metric;
  std::string expr;
  std::vector<Plan::SweptValue> cell;  ///< the cell it was judged in; empty: over all trials
  std::optional<double> value;
  SampleInterval interval;
  Verdict verdict{Verdict::inconclusive};
  std::string reason;
};

/// The verdict on all: fail where one failed, else inconclusive where one was, else pass.
Verdict worst_verdict(const std::vector<GateVerdict>& gates);

/// What a verdict is about, in one line: "success_rate ci_low >= 0.99 (controller.contraction.eta1 = 0.5)".
std::string gate_title(const GateVerdict& gate);

}  // namespace steerstat
