#pragma once

#include <string_view>
#include <vector>

namespace steerstat {

/// A document that the program carries.
struct EmbeddedDocument {
  std::string_view name;
  std::string_view text;
};

/// schemas/*.schema.json, by name.
const std::vector<EmbeddedDocument>& embedded_schemas();

/// schemas/openapi.yaml as JSON, its references to the schemas as the service serves them.
std::string_view embedded_openapi();

}  // namespace steerstat
