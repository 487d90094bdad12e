#include "sidestep/sim/mjcf_tags.h"

namespace sidestep::sim {

bool FindTag(std::string_view xml, std::string_view name, std::size_t from, XmlTag* tag) {
  for (std::size_t at = xml.find('<', from); at != std::string_view::npos;
       at = xml.find('<', at + 1)) {
    if (xml.substr(at, 4) == "<!--") {
      at = xml.find("-->", at);
      if (at == std::string_view::npos) return false;
      continue;
    }
    const std::size_t behind = at + 1 + name.size();
    if (xml.substr(at + 1, name.size()) != name || behind >= xml.size()) continue;
    if (std::string_view(" \t\n/>").find(xml[behind]) == std::string_view::npos) continue;
    char quote = 0;
    for (std::size_t end = behind; end < xml.size(); ++end) {
      const char c = xml[end];
      if (quote != 0) {
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '>') {
        *tag = {at, end + 1};
        return true;
      }
    }
    return false;
  }
  return false;
}

}  // namespace sidestep::sim
