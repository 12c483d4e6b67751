#include "core/version.hpp"

namespace steerstat {

std::string_view engine_version() {
  return STEERSTAT_VERSION;
}

}  // namespace steerstat
