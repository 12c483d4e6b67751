#include "report/pairing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <variant>

#include "study/inputs.hpp"
#include "study/plan.hpp"

namespace steerstat {
namespace {

std::string joined(const std::vector<std::string>& reasons) {
  std::string text = "the two studies cannot be compared trial by trial:";
  for (const std::string& reason : reasons) text += "\n" + reason;
  return text;
}

/// The pointer of an input: "/plant/m1".
std::string pointer_of(std::string name) {
  std::replace(name.begin(), name.end(), '.', '/');
  return '/' + name;
}

bool is_at_or_below(const std::string& pointer, const std::string& place) {
  return pointer == place || pointer.starts_with(place + '/');
}

std::string shown(const std::optional<std::string>& value) {
  return value.value_or("nothing");
}

std::string sides(const SpecDifference& difference) {
  return fmt::format("{}: {} in A, {} in B", difference.pointer, shown(difference.a), shown(difference.b));
}

class Reasons {
 public:
  Reasons(const ComparedStudy& a, const ComparedStudy& b, const std::vector<SpecDifference>& differences)
      : a_(a.study), b_(b.study), differences_(differences) {}

  std::vector<std::string> find() {
    sampling();
    for (const Input& input : a_.inputs) drawn(input);
    listed();
    sweeps();
    return std::move(reasons_);
  }

 private:
  // A seed decides nothing where nothing is drawn, but then the studies have one draw or list their trials.
  void sampling() {
    if (seeks_failures(a_.sampling.method) || seeks_failures(b_.sampling.method)) {
      reasons_.push_back(
          "/sampling/method: trials drawn where failures are (pairs count one each only where they are drawn as they "
          "come); run both with monte_carlo");
    }
    for (const SpecDifference& difference : differences_) {
      if (difference.pointer.starts_with("/sampling/")) {
        reasons_.push_back(sides(difference) + " (the same draws need the same sampling); run both with one of them");
      }
    }
    if (a_.sampling.method == SamplingMethod::latin_hypercube && b_.sampling.method == a_.sampling.method &&
        a_.sampling.trials != b_.sampling.trials) {
      reasons_.push_back(fmt::format(
          "/sampling/trials: {} in A, {} in B (the draws of a Latin hypercube depend on how many there are); "
          "run both with as many",
          a_.sampling.trials, b_.sampling.trials));
    }
  }

  void drawn(const Input& of_a) {
    const auto found = std::find_if(b_.inputs.begin(), b_.inputs.end(),
                                    [&](const Input& candidate) { return candidate.name == of_a.name; });
    if (found == b_.inputs.end()) return;
    const auto* in_a = std::get_if<Distribution>(&of_a.value);
    const auto* in_b = std::get_if<Distribution>(&found->value);
    if (in_a == nullptr && in_b == nullptr) return;
    const std::string pointer = pointer_of(of_a.name);
    if (in_a == nullptr || in_b == nullptr) {
      reasons_.push_back(
          fmt::format("{}: drawn in {} alone (both must draw the same inputs); draw it in both or fix it", pointer,
                      in_a == nullptr ? "B" : "A"));
      return;
    }
    for (const SpecDifference& difference : differences_) {
      if (!is_at_or_below(difference.pointer, pointer)) continue;
      reasons_.push_back(sides(difference) + " (both must draw it from the same distribution); use one of them");
    }
    if (in_a->relative && in_b->relative && of_a.name.starts_with("plant.")) relative(of_a.name);
  }

  // The draws of a relative distribution multiply the nominal value.
  void relative(const std::string& name) {
    const std::string nominal = "/nominal/" + name.substr(name.find('.') + 1);
    for (const SpecDifference& difference : differences_) {
      if (difference.pointer != nominal) continue;
      reasons_.push_back(fmt::format("{} (the draws of {} are relative to it); make them absolute", sides(difference),
                                     pointer_of(name)));
    }
  }

  void listed() {
    if (a_.sampling.explicit_names == b_.sampling.explicit_names) return;
    reasons_.push_back(fmt::format("/sampling/trials: A lists {}, B {} (both must list the same inputs); list the same",
                                   fmt::join(a_.sampling.explicit_names, ", "),
                                   fmt::join(b_.sampling.explicit_names, ", ")));
  }

  void sweeps() {
    const Plan a(a_);
    const Plan b(b_);
    if (a.cells() == 1 && b.cells() == 1) return;
    bool same = a.cells() == b.cells();
    for (std::uint64_t cell = 0; same && cell < a.cells(); ++cell) {
      const auto in_a = a.sweep_values(cell);
      const auto in_b = b.sweep_values(cell);
      same = std::equal(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                        [](const auto& x, const auto& y) { return x.name == y.name && x.value == y.value; });
    }
    if (same) return;
    reasons_.push_back(
        fmt::format("the sweeps differ: {} in A, {} in B (trials pair cell by cell); sweep the same values in both",
                    described(a), described(b)));
  }

  static std::string described(const Plan& plan) {
    std::string names;
    for (const Plan::SweptValue& swept : plan.sweep_values(0)) names += (names.empty() ? "" : " x ") + swept.name;
    return names.empty() ? "none" : fmt::format("{} cells of {}", plan.cells(), names);
  }

  const Study& a_;
  const Study& b_;
  const std::vector<SpecDifference>& differences_;
  std::vector<std::string> reasons_;
};

std::vector<std::pair<std::size_t, std::size_t>> common_rows(const Plan& plan, const TrialTable& a,
                                                             const TrialTable& b) {
  std::vector<std::pair<std::size_t, std::size_t>> rows;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.index.size() && j < b.index.size()) {
    if (a.index[i] < b.index[j]) {
      ++i;
    } else if (b.index[j] < a.index[i]) {
      ++j;
    } else {
      // Of a pick-freeze design's rows only A and B are independent of each other.
      if (plan.is_independent(a.index[i])) rows.emplace_back(i, j);
      ++i;
      ++j;
    }
  }
  return rows;
}

/// The names of the inputs whose values come from draws or from a list.
std::vector<std::string> drawn_names(const Study& study) {
  std::vector<std::string> names;
  for (const Input& input : study.inputs) {
    const auto& listed = study.sampling.explicit_names;
    const bool is_listed = std::find(listed.begin(), listed.end(), input.name) != listed.end();
    if (is_listed || std::holds_alternative<Distribution>(input.value)) names.push_back(input.name);
  }
  return names;
}

const std::vector<double>& column(const ComparedStudy& side, const std::string& name) {
  const std::vector<std::string> varying = Plan(side.study).varying();
  const auto found = std::find(varying.begin(), varying.end(), name);
  return side.parameters.at(static_cast<std::size_t>(found - varying.begin()));
}

/// The first pair whose stored values of an input differ, in words.
std::optional<std::string> mismatch(const ComparedStudy& a, const ComparedStudy& b, const std::string& name,
                                    const Pairing& pairing) {
  const std::vector<double>& in_a = column(a, name);
  const std::vector<double>& in_b = column(b, name);
  for (const auto& [row_a, row_b] : pairing.rows) {
    const double x = in_a[row_a];
    const double y = in_b[row_b];
    if (std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y)) continue;
    return fmt::format(
        "{} of trial {} is {} in A and {} in B (paired trials must have drawn the same bits); run both with as many "
        "trials, the same design and the same engine",
        name, a.result.trials.index[row_a], x, y);
  }
  return std::nullopt;
}

}  // namespace

StudiesDoNotPair::StudiesDoNotPair(std::vector<std::string> reasons)
    : BadUsage(joined(reasons)), reasons_(std::move(reasons)) {}

Pairing pair_trials(const ComparedStudy& a, const ComparedStudy& b, const std::vector<SpecDifference>& differences) {
  std::vector<std::string> reasons = Reasons(a, b, differences).find();
  if (!reasons.empty()) throw StudiesDoNotPair(std::move(reasons));
  Pairing pairing{common_rows(Plan(a.study), a.result.trials, b.result.trials), drawn_names(a.study)};
  if (pairing.rows.empty()) {
    throw StudiesDoNotPair({"no trial has finished in both (a pair needs one of each); let both run further"});
  }
  for (const std::string& name : pairing.drawn) {
    if (auto reason = mismatch(a, b, name, pairing)) reasons.push_back(*std::move(reason));
  }
  if (!reasons.empty()) throw StudiesDoNotPair(std::move(reasons));
  return pairing;
}

}  // namespace steerstat
