#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/elementary.hpp"
#include "core/instruction_set.hpp"
#include "pack_values.hpp"

namespace steerstat {

#if defined(__x86_64__)
namespace avx512 {
void evaluate_packs(int function, const double* in, double* out, std::size_t count);
}
namespace avx2 {
void evaluate_packs(int function, const double* in, double* out, std::size_t count);
}
#endif
namespace portable {
void evaluate_packs(int function, const double* in, double* out, std::size_t count);
}

namespace testing {

void evaluate(InstructionSet set, PackFunction function, std::span<const double> in, std::span<double> out) {
  const int f = static_cast<int>(function);
#if defined(__x86_64__)
  if (set == InstructionSet::avx512) return avx512::evaluate_packs(f, in.data(), out.data(), in.size());
  if (set == InstructionSet::avx2) return avx2::evaluate_packs(f, in.data(), out.data(), in.size());
#endif
  portable::evaluate_packs(f, in.data(), out.data(), in.size());
}

namespace {

std::vector<double> evaluated(InstructionSet set, PackFunction function, const std::vector<double>& in) {
  std::vector<double> out(in.size());
  evaluate(set, function, in, out);
  return out;
}

class EveryPack : public ::testing::TestWithParam<InstructionSet> {};

/// The instruction sets of this machine: on another there is nothing to test.
std::vector<InstructionSet> supported_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::portable}) {
    if (supports(set)) sets.push_back(set);
  }
  return sets;
}

std::vector<double> angles() {
  std::vector<double> in;
  for (int k = 0; in.size() < 160000; ++k) {
    in.push_back(0.0371 * (k % 2 == 0 ? k : -k) + 1e-9 * k * k);
    in.push_back(1.5707963267948966 * (k - 40000) + 1e-3 * std::sin(k));
  }
  return in;
}

TEST_P(EveryPack, SineAndCosineHaveTheBitsOfTheScalarFunctions) {
  const std::vector<double> in = angles();
  const std::vector<double> sine = evaluated(GetParam(), PackFunction::sine, in);
  const std::vector<double> cosine = evaluated(GetParam(), PackFunction::cosine, in);
  for (std::size_t i = 0; i < in.size(); ++i) {
    ASSERT_EQ(sine[i], sincos(in[i]).sin) << in[i];
    ASSERT_EQ(cosine[i], sincos(in[i]).cos) << in[i];
  }
}

TEST_P(EveryPack, CoarseLogarithmIsWithinItsBoundOverTheNormalRange) {
  std::vector<double> in;
  for (double x = 1e-300; in.size() < 16000; x *= 1.0877) in.push_back(x < 1e300 ? x : x = 1.01e-300);
  const std::vector<double> out = evaluated(GetParam(), PackFunction::coarse_log2, in);
  for (std::size_t i = 0; i < in.size(); ++i) {
    ASSERT_NEAR(out[i], static_cast<double>(std::log2(static_cast<long double>(in[i]))), 1.2e-4) << in[i];
  }
}

TEST_P(EveryPack, CoarsePowerIsWithinItsBoundFromMinusToPlusAThousand) {
  std::vector<double> in;
  for (int k = 0; k < 32000; ++k) in.push_back(-1000.0 + k * (2000.0 / 31999.0));
  const std::vector<double> out = evaluated(GetParam(), PackFunction::coarse_exp2, in);
  for (std::size_t i = 0; i < in.size(); ++i) {
    const long double expected = std::exp2(static_cast<long double>(in[i]));
    ASSERT_LT(std::abs(static_cast<long double>(out[i]) - expected), 1e-4L * expected) << in[i];
  }
}

TEST_P(EveryPack, NarrowingRoundsToNearestAndKeepsTheLanesInOrder) {
  std::vector<double> in;
  for (int k = 0; k < 1600; ++k) in.push_back(std::sin(k) * std::pow(10.0, k % 60 - 30));
  const std::vector<double> out = evaluated(GetParam(), PackFunction::narrowed, in);
  for (std::size_t i = 0; i < in.size(); ++i) {
    ASSERT_EQ(out[i], static_cast<double>(static_cast<float>(in[i]))) << i;
  }
}

TEST_P(EveryPack, SquareRootIsTheCorrectlyRoundedOne) {
  std::vector<double> in;
  for (int k = 0; k < 1600; ++k) in.push_back((1.5 + std::sin(k)) * std::pow(10.0, k % 600 - 300));
  const std::vector<double> out = evaluated(GetParam(), PackFunction::square_root, in);
  for (std::size_t i = 0; i < in.size(); ++i) ASSERT_EQ(out[i], std::sqrt(in[i])) << in[i];
}

INSTANTIATE_TEST_SUITE_P(Packs, EveryPack, ::testing::ValuesIn(supported_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

}  // namespace
}  // namespace testing
}  // namespace steerstat
