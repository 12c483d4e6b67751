// Writes the points of a design, for programs that are not ours to judge.
//
//   write_design_points DESIGN DIMENSIONS POINTS SEEDS
//
// DESIGN  sequence (Sobol's, unscrambled), sobol or latin_hypercube
// SEEDS   how many designs: those of seeds 0, 1, ..., one after the other
//
// A line a point, its coordinates separated by spaces, in hexadecimal floating point.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "sampling/latin_hypercube.hpp"
#include "sampling/sobol.hpp"

namespace steerstat {
namespace {

class Sequence : public Design {
 public:
  explicit Sequence(std::size_t dimensions) : sequence_(dimensions) {}
  [[nodiscard]] double coordinate(std::uint64_t draw, std::size_t variable) const override {
    return std::ldexp(static_cast<double>(sequence_.at(draw, variable)), -static_cast<int>(SobolSequence::digits));
  }

 private:
  SobolSequence sequence_;
};

std::unique_ptr<Design> design_called(const std::string& name, std::size_t dimensions, std::uint64_t points,
                                      std::uint64_t seed) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < dimensions; ++i) names.push_back(std::string("x").append(std::to_string(i)));
  if (name == "sequence") return std::make_unique<Sequence>(dimensions);
  if (name == "sobol") return std::make_unique<Sobol>(seed, names);
  if (name == "latin_hypercube") return std::make_unique<LatinHypercube>(points, seed, names);
  return nullptr;
}

}  // namespace
}  // namespace steerstat

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const std::size_t dimensions = std::stoul(argv[2]);
  const std::uint64_t points = std::stoull(argv[3]);
  const std::uint64_t seeds = std::stoull(argv[4]);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto design = steerstat::design_called(argv[1], dimensions, points, seed);
    if (design == nullptr) return 2;
    for (std::uint64_t point = 0; point < points; ++point) {
      for (std::size_t i = 0; i < dimensions; ++i) {
        std::printf("%a%c", design->coordinate(point, i), i + 1 < dimensions ? ' ' : '\n');
      }
    }
  }
}
