// libFuzzer's target: whatever the bytes, the decoder gives a study or says what is wrong, and every study it gives
// comes back from its canonical form. tests/fuzz/run builds it and runs it.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <variant>

#include "core/errors.hpp"
#include "study/approximation.hpp"
#include "study/spec_json.hpp"

namespace {

using namespace steerstat;

[[noreturn]] void report(const char* claim, const std::string& canonical, const std::string& again) {
  std::fprintf(stderr, "%s\n%s\n%s\n", claim, canonical.c_str(), again.c_str());
  std::abort();
}

void check(std::string_view text) {
  std::string canonical;
  try {
    canonical = canonical_spec(decode_study(text, {}));
  } catch (const BadSpec&) {
    return;  // it said what is wrong
  }
  std::string again;
  try {
    again = canonical_spec(decode_study(canonical, {}));
  } catch (const BadSpec& bad) {
    report("the canonical form is refused", canonical, bad.what());
  }
  if (canonical != again) report("the canonical form of the canonical form is another", canonical, again);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check({reinterpret_cast<const char*>(data), size});
  return 0;
}
