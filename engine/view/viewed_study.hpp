#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "study/plan.hpp"
#include "study/run.hpp"
#include "study/study.hpp"

/// Documents that a page draws (schemas/view.schema.json), as values; *_json.cpp writes them. All functions are pure
/// and thread-safe.
namespace steerstat {

/// Of schemas/view.schema.json.
inline constexpr int view_version = 1;

/// A study and its finished trials, as its views are made of them. Borrows them.
struct ViewedStudy {
  const Study& study;
  const StudyResult& result;
  const std::vector<std::vector<double>>& parameters;  ///< (varying x rows), in the order of Plan::varying()
};

/// What names a study.
struct StudyIdentity {
  std::string id;
  std::string name;
};

StudyIdentity identity_of(const Study& study);

/// The rows of the trials that count: all, but of a study of Sobol' indices A and B of each row alone, which are
/// independent.
std::vector<std::size_t> rows_that_count(const Plan& plan, const TrialTable& trials);

/// The values of the varying inputs, drawn anew, of finished trials whose parameters nobody stored.
/// @return (varying x rows)
std::vector<std::vector<double>> drawn_parameters(const Plan& plan, const TrialTable& trials);

}  // namespace steerstat
