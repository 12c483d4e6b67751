#include "report/sensitivity_json.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::ordered_json;

Json member_or_null(const SensitivityIndex* index, double SensitivityIndex::*member) {
  return index != nullptr ? Json(index->*member) : Json(nullptr);
}

Json sobol_output_json(const SobolSensitivity::Output& output, const std::vector<std::string>& inputs) {
  Json list = Json::array();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const SensitivityIndex* first_order = output.indices ? &(*output.indices)[i].first_order : nullptr;
    const SensitivityIndex* total = output.indices ? &(*output.indices)[i].total : nullptr;
    list.push_back({{"input", inputs[i]},
                    {"first_order", member_or_null(first_order, &SensitivityIndex::estimate)},
                    {"ci_low", member_or_null(first_order, &SensitivityIndex::low)},
                    {"ci_high", member_or_null(first_order, &SensitivityIndex::high)},
                    {"total", member_or_null(total, &SensitivityIndex::estimate)},
                    {"total_ci_low", member_or_null(total, &SensitivityIndex::low)},
                    {"total_ci_high", member_or_null(total, &SensitivityIndex::high)}});
  }
  return list;
}

Json given_data_json(const GivenDataSensitivity& given) {
  Json outputs = Json::array();
  for (const GivenDataSensitivity::Output& output : given.outputs) {
    Json list = Json::array();
    for (std::size_t i = 0; i < given.inputs.size(); ++i) {
      const SensitivityIndex* index = output.indices[i] ? &*output.indices[i] : nullptr;
      list.push_back({{"input", given.inputs[i]},
                      {"first_order", member_or_null(index, &SensitivityIndex::estimate)},
                      {"ci_low", member_or_null(index, &SensitivityIndex::low)},
                      {"ci_high", member_or_null(index, &SensitivityIndex::high)}});
    }
    outputs.push_back({{"metric", output.name}, {"trials", output.trials}, {"inputs", std::move(list)}});
  }
  return {{"exact", given.exact}, {"level", given.level}, {"outputs", std::move(outputs)}};
}

}  // namespace

Json sobol_json(const std::optional<SobolSensitivity>& sobol) {
  if (!sobol) return nullptr;
  Json json = {{"level", sobol->level}, {"independent_trials", sobol->independent_trials}};
  json["rows"] = Json::object();
  for (const SobolSensitivity::Output& output : sobol->outputs) json["rows"][output.name] = output.rows;
  for (const SobolSensitivity::Output& output : sobol->outputs) {
    json[output.name] = sobol_output_json(output, sobol->inputs);
  }
  return json;
}

std::string sensitivity_json(const SensitivityReport& report) {
  Json json;
  json["study"] = {{"id", report.id}, {"name", report.name}};
  json["complete"] = report.complete;
  json["given_data"] = given_data_json(report.given_data);
  json["sobol_indices"] = sobol_json(report.sobol);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace steerstat
