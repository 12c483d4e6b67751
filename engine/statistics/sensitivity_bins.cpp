#include "statistics/sensitivity_bins.hpp"

#include <algorithm>
#include <tuple>

namespace steerstat {
namespace {

constexpr std::size_t most_bins = 4096;
constexpr std::size_t entries_a_bin = 8;

// Makes one entry of neighbours for which `same` holds.
template <class Same>
void merge_neighbours(std::vector<BinEntry>& entries, const Same& same) {
  std::size_t kept = 0;
  for (const BinEntry& entry : entries) {
    if (kept > 0 && same(entries[kept - 1], entry)) {
      entries[kept - 1].count += entry.count;
      entries[kept - 1].sum += entry.sum;
      entries[kept - 1].squares += entry.squares;
    } else {
      entries[kept++] = entry;
    }
  }
  entries.resize(kept);
}

}  // namespace

std::vector<BinEntry> sorted_entries(std::span<const double> x, std::span<const double> y,
                                     std::span<const std::uint64_t> unit) {
  struct Key {
    double x;
    std::uint64_t unit;
    std::size_t trial;
  };
  std::vector<Key> keys(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) keys[i] = {x[i], unit[i], i};
  std::sort(keys.begin(), keys.end(), [](const Key& p, const Key& q) {
    if (p.x != q.x) return p.x < q.x;
    return std::tie(p.unit, p.trial) < std::tie(q.unit, q.trial);
  });
  std::vector<BinEntry> entries;
  entries.reserve(x.size());
  for (const Key& key : keys) entries.push_back({key.x, key.unit, 1.0, y[key.trial], y[key.trial] * y[key.trial]});
  merge_neighbours(entries, [](const BinEntry& p, const BinEntry& q) { return p.x == q.x && p.unit == q.unit; });
  return entries;
}

std::vector<std::size_t> bin_ends(std::span<const BinEntry> entries) {
  const std::size_t n = entries.size();
  std::vector<std::size_t> value_ends;
  for (std::size_t i = 1; i <= n; ++i) {
    if (i == n || entries[i].x != entries[i - 1].x) value_ends.push_back(i);
  }
  if (value_ends.size() * entries_a_bin <= n) return value_ends;
  const std::size_t bins = std::clamp(n / entries_a_bin, std::size_t{1}, most_bins);
  std::vector<std::size_t> ends;
  for (const std::size_t end : value_ends) {
    if (end == n || end * bins >= (ends.size() + 1) * n) ends.push_back(end);
  }
  return ends;
}

void merge_units(std::vector<BinEntry>& entries) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const BinEntry& p, const BinEntry& q) { return p.unit < q.unit; });
  merge_neighbours(entries, [](const BinEntry& p, const BinEntry& q) { return p.unit == q.unit; });
}

}  // namespace steerstat
