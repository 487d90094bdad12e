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

}  // namespace sidestep
