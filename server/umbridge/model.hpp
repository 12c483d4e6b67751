#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "study/parse_json.hpp"

namespace steerstat {

/// A model does not answer: what a client of UM-Bridge reads as `{"error": {"type", "message"}}`.
class ModelRefusal : public std::runtime_error {
 public:
  ModelRefusal(std::string_view type, const std::string& message) : std::runtime_error(message), type_(type) {}
  [[nodiscard]] const std::string& type() const { return type_; }

  static constexpr std::string_view not_found = "ModelNotFound";
  static constexpr std::string_view invalid_input = "InvalidInput";
  static constexpr std::string_view invalid_output = "InvalidOutput";
  static constexpr std::string_view unsupported = "UnsupportedFeature";
  static constexpr std::string_view unavailable = "Unavailable";  ///< now; not the model's doing

 private:
  std::string type_;
};

/// A function from one vector to one vector of finite numbers, as UM-Bridge has it, which a client may bend by a
/// `config`: a JSON object, whose keys are the model's own. Safe to call from several threads.
///
/// All throw ModelRefusal for a config that makes no sense.
class Model {
 public:
  Model() = default;
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  virtual ~Model() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;

  /// How long the input is.
  [[nodiscard]] virtual std::size_t inputs(const Json& config) const = 0;

  /// How long the output is.
  [[nodiscard]] virtual std::size_t outputs() const = 0;

  /// @param input  (inputs(config)), finite
  /// @return       (outputs()), finite
  [[nodiscard]] virtual std::vector<double> evaluate(std::span<const double> input, const Json& config) const = 0;
};

/// The dotted names of inputs in `config.inputs`, each of which a spec knows and which are listed once.
/// @param defaults  those of a config that names none
std::vector<std::string> named_inputs(const Json& config, std::span<const std::string_view> defaults);

/// Refuses keys that are none of a model's. @param known  its keys
void require_known_keys(const Json& config, std::span<const std::string_view> known);

/// Puts a value where a dotted name stands in a spec, in place of whatever stands there.
void put(Json& spec, std::string_view dotted_name, double value);

}  // namespace steerstat
