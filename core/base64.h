#pragma once

#include <string>
#include <string_view>

namespace sidestep {

/// Bytes as text, in the alphabet of RFC 4648, filled up with '='.
std::string Base64(std::string_view bytes);

}  // namespace sidestep
