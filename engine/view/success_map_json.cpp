#include "view/columns_json.hpp"

namespace steerstat {

std::string success_map_json(const SuccessMap& map) {
  return view_json::text(view_json::success_map(map));
}

}  // namespace steerstat
