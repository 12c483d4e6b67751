#pragma once

#include <string_view>

namespace steerstat {

/// Whether a client that sends this Accept takes a document of this type [RFC 9110, 12.5.1]: the most specific range
/// that it is in decides. Parameters other than q are passed over, and so are ranges that are none.
///
/// @param accept  the field's value; "" where it was not sent, which takes everything
/// @param type    "application/json"
bool accepts(std::string_view accept, std::string_view type);

}  // namespace steerstat
