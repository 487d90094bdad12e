#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace sidestep {

/// The whole of a text as a number of this kind, whatever the locale; none if it is anything else,
/// or out of range.
template <class Number>
std::optional<Number> NumberIn(std::string_view text) {
  Number number = {};
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || last != end) return std::nullopt;
  return number;
}

/// Whether a whole number has zeros before it, "010": to some readers that is ten, to others eight.
inline bool HasLeadingZeros(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  return text.size() > 1 && text.front() == '0' &&
         text.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace sidestep
