#include "report/spec_difference_json.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "study/parse_json.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using Value = nlohmann::json;  // whose objects are sorted by key

constexpr std::array<std::string_view, 6> without_effect{"/name",  "/audit",     "/retain",
                                                         "/gates", "/intervals", "/sampling/trials"};

std::optional<std::string> text_of(const Value* value) {
  if (value == nullptr) return std::nullopt;
  return value->dump();
}

const Value* member(const Value* object, const std::string& key) {
  if (object == nullptr) return nullptr;
  const auto found = object->find(key);
  return found == object->end() ? nullptr : &*found;
}

// A group that one spec lacks is compared as if it were empty, so that each of its values gets an entry.
bool is_group(const Value* value) {
  return value == nullptr || value->is_object();
}

void collect(const Value* a, const Value* b, const std::string& pointer, std::vector<SpecDifference>& differences) {
  if (std::find(without_effect.begin(), without_effect.end(), pointer) != without_effect.end()) return;
  if (a != nullptr && b != nullptr && *a == *b) return;
  if (!is_group(a) || !is_group(b)) {
    differences.push_back({pointer, text_of(a), text_of(b)});
    return;
  }
  std::set<std::string> keys;
  for (const Value* group : {a, b}) {
    if (group == nullptr) continue;
    for (const auto& [key, value] : group->items()) keys.insert(key);
  }
  for (const std::string& key : keys) {
    collect(member(a, key), member(b, key), pointer + '/' + pointer_token(key), differences);
  }
}

}  // namespace

std::vector<SpecDifference> spec_differences(const Study& a, const Study& b) {
  const Value first = Value::parse(canonical_spec(a));
  const Value second = Value::parse(canonical_spec(b));
  std::vector<SpecDifference> differences;
  collect(&first, &second, "", differences);
  return differences;
}

}  // namespace steerstat
