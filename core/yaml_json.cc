#include "sidestep/core/yaml_json.h"

#include <fmt/core.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "sidestep/core/utf8.h"

namespace sidestep {
namespace {

std::string QuotedJson(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : EscapeInvalidUtf8(text)) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 32) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

// JSON knows no .5, no 1., no +1, no 0x10, no inf.
bool IsJsonNumber(std::string_view text) {
  double value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return false;
  if (!std::isfinite(value)) return false;
  const std::string_view digits = text.front() == '-' ? text.substr(1) : text;
  const auto is_digit = [&](std::size_t i) {
    return i < digits.size() && digits[i] >= '0' && digits[i] <= '9';
  };
  if (!is_digit(0) || (digits[0] == '0' && is_digit(1))) return false;
  const std::size_t point = digits.find('.');
  return point == std::string_view::npos || is_digit(point + 1);
}

std::string ToJson(const YAML::Node& node) {
  std::string text;
  switch (node.Type()) {
    case YAML::NodeType::Map:
      for (const auto& entry : node) {
        text += (text.empty() ? "" : ",") + QuotedJson(entry.first.Scalar()) + ":" +
                ToJson(entry.second);
      }
      return "{" + text + "}";
    case YAML::NodeType::Sequence:
      for (const auto& item : node) text += (text.empty() ? "" : ",") + ToJson(item);
      return "[" + text + "]";
    case YAML::NodeType::Scalar: {
      const std::string& word = node.Scalar();
      const bool is_in_quotes = node.Tag() == "!";
      const bool stays = !is_in_quotes && (word == "true" || word == "false" || IsJsonNumber(word));
      return stays ? word : QuotedJson(word);
    }
    default:
      return "null";
  }
}

}  // namespace

std::string YamlToJson(const std::string& yaml) {
  try {
    return ToJson(YAML::Load(yaml));
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(std::string("YamlToJson: ") + error.what());
  }
}

}  // namespace sidestep
