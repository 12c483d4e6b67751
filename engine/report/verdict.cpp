#include "report/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace steerstat {
namespace {

/// What decides a comparison.
enum class Basis {
  interval,  ///< all of the interval
  bound,     ///< one bound of the interval, whatever the other
  number     ///< a number known exactly
};

Basis basis_of(const GateExpression& expression) {
  switch (expression.quantity) {
    case Quantity::min:
    case Quantity::max:
    case Quantity::count:
      return Basis::number;
    case Quantity::ci_low:
      return expression.wants_more() ? Basis::interval : Basis::bound;
    case Quantity::ci_high:
      return expression.wants_more() ? Basis::bound : Basis::interval;
    default:
      return Basis::interval;
  }
}

/// Whether trials that have not run yet may turn a fail into a pass, the finished ones being what they are.
bool more_may_mend(const GateExpression& expression) {
  switch (expression.quantity) {
    case Quantity::min:
      return !expression.wants_more();  // a minimum only falls
    case Quantity::max:
    case Quantity::count:
      return expression.wants_more();  // these only grow
    default:
      return false;
  }
}

std::string bounds_text(const SampleInterval& interval) {
  const auto side = [](const std::optional<double>& limit, const char* without) {
    return limit ? fmt::format("{:.6g}", *limit) : std::string(without);
  };
  return fmt::format("{} to {}", side(interval.low, "unbounded below"), side(interval.high, "unbounded above"));
}

Judgement judge_interval(const GateExpression& expression, const SampleInterval& interval) {
  // The end of the interval that satisfies the comparison last, and the one that does first.
  const std::optional<double>& hardest = expression.wants_more() ? interval.low : interval.high;
  const std::optional<double>& easiest = expression.wants_more() ? interval.high : interval.low;
  const std::string text = bounds_text(interval);
  if (hardest && expression.holds(*hardest)) return {Verdict::pass, fmt::format("all of the interval, {}", text)};
  if (easiest && !expression.holds(*easiest)) return {Verdict::fail, fmt::format("none of the interval, {}", text)};
  if (!hardest || !easiest) {
    return {Verdict::inconclusive, fmt::format("too few trials for the interval, {}; run more", text)};
  }
  return {Verdict::inconclusive,
          fmt::format("the interval, {}, straddles {:.6g}; run more trials", text, expression.bound)};
}

Judgement judge_number(const GateExpression& expression, double x) {
  const std::string_view quantity = quantity_names[static_cast<std::size_t>(expression.quantity)];
  return {expression.holds(x) ? Verdict::pass : Verdict::fail, fmt::format("{} is {:.6g}", quantity, x)};
}

}  // namespace

Judgement judge(const GateExpression& expression, const Evidence& evidence, std::string_view shortfall) {
  if (!evidence.value) {
    return {Verdict::inconclusive, shortfall.empty() ? "no data" : fmt::format("no data; {}", shortfall)};
  }
  if (!evidence.doubt.empty() && basis_of(expression) != Basis::number) {
    return {Verdict::inconclusive, std::string(evidence.doubt)};
  }
  Judgement judgement = basis_of(expression) == Basis::interval ? judge_interval(expression, evidence.interval)
                                                                : judge_number(expression, *evidence.value);
  if (shortfall.empty() || judgement.verdict == Verdict::inconclusive) return judgement;
  if (judgement.verdict == Verdict::fail && !more_may_mend(expression)) return judgement;
  return {Verdict::inconclusive,
          fmt::format("would {} ({}), but {}", name_of(judgement.verdict), judgement.reason, shortfall)};
}

Verdict worst_verdict(const std::vector<GateVerdict>& gates) {
  const auto any = [&](Verdict verdict) {
    return std::any_of(gates.begin(), gates.end(), [&](const GateVerdict& gate) { return gate.verdict == verdict; });
  };
  if (any(Verdict::fail)) return Verdict::fail;
  return any(Verdict::inconclusive) ? Verdict::inconclusive : Verdict::pass;
}

std::string gate_title(const GateVerdict& gate) {
  std::string title = fmt::format("{} {}", gate.metric, gate.expr);
  for (std::size_t i = 0; i < gate.cell.size(); ++i) {
    title += fmt::format("{}{} = {}", i == 0 ? " (" : ", ", gate.cell[i].name, gate.cell[i].value);
  }
  return gate.cell.empty() ? title : title + ")";
}

}  // namespace steerstat
