#pragma once

#include <string>
#include <vector>

#include "study/gate.hpp"
#include "study/reader_json.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes a spec's `gates`.
///
/// @param inputs    the study's, decoded: a gate's cell names what is swept
/// @param measured  whether the study measures optional metrics; a gate on one that it leaves out is a mistake
/// @param mistaken  names of inputs with mistakes of their own: nothing is said of gates on their cells
/// @return with what could be read where mistakes were noted
std::vector<Gate> decode_gates(const Reader& reader, const std::vector<Input>& inputs, bool measured,
                               const std::vector<std::string>& mistaken);

/// Gates as a spec writes them, each expression with its quantity first.
nlohmann::json encode_gates(const std::vector<Gate>& gates);

/// Decodes a spec's `baseline`. @return with defaults where mistakes were noted
BaselineTest decode_baseline_test(const Reader& reader);

/// A baseline's test as a spec writes it.
nlohmann::json encode_baseline_test(const BaselineTest& test);

}  // namespace steerstat
