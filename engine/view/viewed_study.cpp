#include "view/viewed_study.hpp"

#include "study/spec_json.hpp"

namespace steerstat {

StudyIdentity identity_of(const Study& study) {
  return {study_id(study), study.name};
}

std::vector<std::size_t> rows_that_count(const Plan& plan, const TrialTable& trials) {
  std::vector<std::size_t> rows;
  rows.reserve(trials.index.size());
  for (std::size_t row = 0; row < trials.index.size(); ++row) {
    if (plan.is_independent(trials.index[row])) rows.push_back(row);
  }
  return rows;
}

std::vector<std::vector<double>> drawn_parameters(const Plan& plan, const TrialTable& trials) {
  std::vector<std::vector<double>> columns(plan.varying().size());
  for (std::vector<double>& column : columns) column.reserve(trials.index.size());
  std::vector<double> values(columns.size());
  for (const std::uint64_t index : trials.index) {
    plan.draw(index, values);
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(values[i]);
  }
  return columns;
}

}  // namespace steerstat
