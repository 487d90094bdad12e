#include "sidestep/bench/json_text.h"

#include <cmath>

#include "sidestep/core/utf8.h"

namespace sidestep::bench {
namespace {

void EscapeAll(nlohmann::ordered_json& json) {
  if (json.is_string()) json = EscapeInvalidUtf8(json.get_ref<const std::string&>());
  if (json.is_object()) {
    nlohmann::ordered_json escaped = nlohmann::ordered_json::object();
    for (auto& [key, value] : json.items()) {
      EscapeAll(value);
      escaped[EscapeInvalidUtf8(key)] = std::move(value);
    }
    json = std::move(escaped);
  }
  if (json.is_array()) {
    for (nlohmann::ordered_json& value : json) EscapeAll(value);
  }
}

}  // namespace

std::string JsonText(nlohmann::ordered_json json) {
  EscapeAll(json);
  return json.dump(2) + "\n";
}

std::string JsonLine(nlohmann::ordered_json json) {
  EscapeAll(json);
  return json.dump();
}

nlohmann::ordered_json NumberOrNull(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace sidestep::bench
