#include "sidestep/cli/varied_keys.h"

#include <algorithm>
#include <cstddef>

#include "sidestep/core/input_error.h"

namespace sidestep::cli {
namespace {

// Cuts at each separator that stands outside brackets, braces and quotes.
std::vector<std::string> Cut(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == separator && depth == 0) {
      parts.emplace_back();
      continue;
    }
    parts.back() += c;
  }
  return parts;
}

}  // namespace

VariedKeys ParseVariedKeys(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--vary", "must be KEY=VALUE,VALUE,..., is '" + text + "'");
  }
  VariedKeys varied{text.substr(0, equals), Cut(text.substr(equals + 1), ',')};
  const std::size_t num_keys = Cut(varied.factor, '/').size();
  for (const std::string& value : varied.values) {
    if (num_keys > 1 && Cut(value, '/').size() != num_keys) {
      throw InputError(
          "--vary " + varied.factor,
          "needs " + std::to_string(num_keys) + " values with / between them, is '" + value + "'");
    }
  }
  return varied;
}

std::vector<std::pair<std::string, std::string>> SettingsOf(const std::string& factor,
                                                            const std::string& value) {
  const std::vector<std::string> keys = Cut(factor, '/');
  if (keys.size() == 1) return {{factor, value}};
  const std::vector<std::string> values = Cut(value, '/');
  std::vector<std::pair<std::string, std::string>> settings;
  for (std::size_t i = 0; i < std::min(keys.size(), values.size()); ++i) {
    settings.emplace_back(keys[i], values[i]);
  }
  return settings;
}

}  // namespace sidestep::cli
