#include "sidestep/core/markup.h"

#include <cctype>

namespace sidestep {

std::string EscapeMarkup(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

InputError XmlFault(const std::string& path, int line, std::string_view name) {
  for (const std::string_view prefix : {"XML_", "ERROR_"}) {
    if (name.starts_with(prefix)) name.remove_prefix(prefix.size());
  }
  std::string why;
  for (const char c : name) {
    why += c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  why = why == "empty document" ? "is empty" : "is no well-formed XML: " + why;
  return line > 0 ? InputError(path, line, "", why) : InputError(path, why);
}

}  // namespace sidestep
