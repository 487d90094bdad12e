#include "sidestep/cli/shell_quote.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstring>

namespace sidestep::cli {

std::string ShellQuoted(const std::string& text) {
  const auto is_ascii = [](char c) { return c >= ' ' && c <= '~'; };
  const auto is_safe = [&](char c) {
    return is_ascii(c) && (std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                           std::strchr("_-./=,:+@%", c) != nullptr);
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_safe)) return text;
  const bool printable = std::all_of(text.begin(), text.end(), is_ascii);
  std::string quoted = printable ? "'" : "$'";
  for (const char c : text) {
    if (printable) {
      quoted += c == '\'' ? "'\\''" : std::string(1, c);
    } else if (is_ascii(c) && c != '\'' && c != '\\') {
      quoted += c;
    } else {
      // Of three digits always, so that a digit that follows is not taken in.
      quoted += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    }
  }
  return quoted + "'";
}

}  // namespace sidestep::cli
