#include "study/share.hpp"

#include <algorithm>
#include <charconv>

#include "study/plan.hpp"
#include "study/run.hpp"

namespace steerstat {
namespace {

/// The whole of `text` as a decimal number.
std::optional<std::uint32_t> parse_number(std::string_view text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<StudyShare> parse_share(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto number = parse_number(text.substr(0, slash));
  const auto count = parse_number(text.substr(slash + 1));
  if (!number || !count || *number < 1 || *number > *count || *count > most_shares) return std::nullopt;
  return StudyShare{*number, *count};
}

std::string share_text(const StudyShare& share) {
  return std::to_string(share.number) + "/" + std::to_string(share.count);
}

TrialRange share_of(std::uint64_t trials, std::uint64_t block, const StudyShare& share) {
  const std::uint64_t blocks = trials / block + (trials % block > 0 ? 1 : 0);
  const std::uint64_t each = blocks / share.count;
  const std::uint64_t rest = blocks % share.count;
  // floor(blocks * part / count), without the product, which may be too large.
  const auto first_block = [&](std::uint64_t part) { return each * part + rest * part / share.count; };
  const auto first_trial = [&](std::uint64_t part) { return std::min(first_block(part) * block, trials); };
  return {first_trial(share.number - 1), first_trial(share.number)};
}

TrialRange trials_of(const Study& study, const StudyShare& share) {
  return share_of(Plan(study).trials(), portion_size(study), share);
}

}  // namespace steerstat
