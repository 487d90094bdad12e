#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sidestep::bench {

/// JSON for a file of its own: indented, with a line end. Bytes that are not UTF-8, which JSON
/// cannot hold, are written out (core/utf8.h).
std::string JsonText(nlohmann::ordered_json json);

/// The same on one line, without its end.
std::string JsonLine(nlohmann::ordered_json json);

}  // namespace sidestep::bench
