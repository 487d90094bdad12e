#include "sidestep/core/page_template.h"

#include <set>
#include <stdexcept>

namespace sidestep {

std::string FillTemplate(std::string_view text,
                         const std::map<std::string, std::string, std::less<>>& parts) {
  constexpr std::string_view kOpen = "{{", kClose = "}}";
  std::string filled;
  std::set<std::string_view> used;
  std::size_t at = 0;
  while (true) {
    const std::size_t begin = text.find(kOpen, at);
    filled += text.substr(at, begin - at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = text.find(kClose, begin);
    const std::string_view name = text.substr(begin + kOpen.size(), end - begin - kOpen.size());
    const auto part = parts.find(name);
    if (end == std::string_view::npos || part == parts.end()) {
      throw std::invalid_argument("FillTemplate: no part '" + std::string(name) + "'");
    }
    filled += part->second;
    used.insert(part->first);
    at = end + kClose.size();
  }
  for (const auto& [name, value] : parts) {
    if (!used.contains(name)) throw std::invalid_argument("FillTemplate: no place for " + name);
  }
  return filled;
}

std::string ScriptJson(std::string_view json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    // In JSON it can only stand within a string.
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace sidestep
