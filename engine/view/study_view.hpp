#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/sensitivity.hpp"
#include "report/summary.hpp"
#include "view/axis.hpp"
#include "view/distribution.hpp"
#include "view/narrowing.hpp"
#include "view/success_map.hpp"
#include "view/viewed_study.hpp"

namespace steerstat {

/// Trials are shown one by one up to this many; maps put more into bins.
inline constexpr std::size_t most_shown_trials = 10'000;

/// At most this many failed trials are listed.
inline constexpr std::size_t most_listed_failures = 500;

/// A heat map's cells are listed up to this many.
inline constexpr std::uint64_t most_listed_cells = 20'000;

/// Sensitivity indices of more trials than this are those of the first so many.
inline constexpr std::size_t most_sensitivity_trials = 100'000;

/// The success rate along one input.
struct Marginal {
  Axis axis;
  BinCounts counts;
  /// (bins) Wilson's interval of each bin for itself; nothing in an empty one. Over several cells the draws of a bin
  /// are its units (clustered_proportion()).
  std::vector<std::optional<ProportionInterval>> intervals;
};

/// Whose rows a view is made of: every trial's; those of a study that seeks failures, which lie where failures are and
/// not as its distributions draw; those of trials that failed (and some that were audited or retained); or hardly any.
enum class ShownRows : std::uint8_t { all, sought, failed, none };
inline constexpr std::array<std::string_view, 4> shown_rows_names{"all", "sought", "failed", "none"};

ShownRows shown_rows(const Study& study);

/// What the page shows of a study beside its summary (schemas/view.schema.json, `study`). Where the rows are not all,
/// what counts trials as they come is left empty: narrowing, distributions, cycles, marginals, sensitivity and maps.
struct StudyView {
  ShownRows rows{ShownRows::all};
  std::optional<std::string> created;  ///< UTC, ISO 8601
  std::string spec;                    ///< canonical
  std::uint64_t used{0};               ///< finished trials that count, whether their rows are there or not
  Narrowing narrowing;
  std::vector<EmpiricalDistribution> distributions;
  struct CycleCounts {
    std::vector<std::uint64_t> from, to;           ///< (bins) cycles, ends included
    std::vector<std::uint64_t> converged, others;  ///< (bins) trials
  };
  CycleCounts cycles;
  struct VaryingInputView {
    std::string input;
    std::string unit;
    enum class Source : std::uint8_t { drawn, swept, listed } source;
    InputValue value;                 ///< what the spec says of it; of a listed one without meaning
    std::optional<double> low, high;  ///< least and greatest value of a trial that counts
  };
  std::vector<VaryingInputView> inputs;
  std::vector<Marginal> marginals;  ///< (inputs); none without trials
  struct SweptAxis {
    std::string input;
    std::string unit;
    std::vector<double> values;  ///< in the order of the spec
  };
  std::vector<SweptAxis> sweeps;  ///< the last one changes fastest from cell to cell
  std::uint64_t sensitivity_of{0};
  GivenDataSensitivity given_data;  ///< of success and settling_time
  struct Sample {
    std::uint64_t of{0};                      ///< trials that count and have a row
    std::vector<std::uint64_t> index;         ///< (shown) rising
    std::vector<Status> status;               ///< (shown)
    std::vector<double> settling_time;        ///< (shown) [s], NaN of a trial that did not converge
    std::vector<std::vector<double>> inputs;  ///< (inputs x shown)
  };
  Sample sample;
  struct Failures {
    std::uint64_t of{0};
    std::vector<std::uint64_t> index;  ///< (listed) rising
    std::vector<Status> status;        ///< (listed)
    std::vector<double> end_time;      ///< (listed) [s]
  };
  Failures failed;
  std::vector<SuccessMap> maps;
};

/// What else a study's view needs to be told.
struct StudyViewOptions {
  std::optional<std::string> created{};  ///< when the trials ran
  /// Maps of this many pairs of inputs at most, where the sample has not all trials: those of the inputs that drive
  /// success most. 0: none, for somebody who asks for maps one by one.
  std::size_t most_maps{0};
};

StudyView study_view(const ViewedStudy& viewed, const StudyViewOptions& options = {});

/// The view as JSON (schemas/view.schema.json), ending in a newline.
///
/// @param summary       of the study's finished trials
/// @param kept_summary  its JSON as it was kept, of a study without sweeps and Sobol' indices: it stands in the view
///                      then, and `summary` needs to have requested, completed and intervals alone
std::string study_view_json(const StudyView& view, const Summary& summary,
                            const std::optional<std::string>& kept_summary = {});

}  // namespace steerstat
