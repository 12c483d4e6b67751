#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.hpp"
#include "view/axis.hpp"
#include "view/viewed_study.hpp"

namespace steerstat {

/// Success over the plane of two inputs, of every trial that counts.
struct SuccessMap {
  StudyIdentity study;
  Axis x, y;
  std::uint64_t of{0};  ///< trials that count
  BinCounts counts;     ///< (bins of y x bins of x)
};

/// An input that does not vary in the study.
class NoSuchAxis : public BadUsage {
 public:
  using BadUsage::BadUsage;
};

/// Puts a study's trials on planes of its inputs; each input is put into bins once.
class MapMaker {
 public:
  /// @param bins  along an axis without levels, > 0
  explicit MapMaker(const ViewedStudy& viewed, std::size_t bins = 40);

  /// @param x, y  positions in Plan::varying()
  [[nodiscard]] SuccessMap map(std::size_t x, std::size_t y);

 private:
  struct Binned {
    Axis axis;
    std::vector<std::uint16_t> bins;  // (trials that count)
  };
  const Binned& binned(std::size_t input);

  const ViewedStudy viewed_;
  const Plan plan_;
  const StudyIdentity identity_;
  std::size_t bins_;
  std::vector<std::size_t> rows_;
  std::vector<std::uint8_t> converged_;
  std::vector<std::optional<Binned>> binned_;  // (varying)
};

/// One map.
/// @param x, y  dotted names of different inputs that vary
/// @throws NoSuchAxis for others, naming those there are; BadUsage for the same name twice or a study without trials
SuccessMap success_map(const ViewedStudy& viewed, std::string_view x, std::string_view y);

/// The map as JSON (schemas/view.schema.json), ending in a newline.
std::string success_map_json(const SuccessMap& map);

}  // namespace steerstat
