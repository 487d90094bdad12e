#include "sidestep/core/utf8.h"

#include <algorithm>

namespace sidestep {
namespace {

std::string Escaped(char c) {
  constexpr char kHexadecimal[] = "0123456789ABCDEF";
  const auto byte = static_cast<unsigned char>(c);
  return {'\\', 'x', kHexadecimal[byte / 16], kHexadecimal[byte % 16]};
}

}  // namespace

std::size_t Utf8Length(std::string_view text) {
  const auto byte = [text](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto is_within = [&byte](std::size_t i, unsigned least, unsigned most) {
    return byte(i) >= least && byte(i) <= most;
  };
  const auto follows = [&is_within](std::size_t i) { return is_within(i, 0x80, 0xBF); };
  if (text.empty()) return 0;
  if (byte(0) < 0x80) return 1;
  if (is_within(0, 0xC2, 0xDF)) return follows(1) ? 2 : 0;
  if (is_within(0, 0xE0, 0xEF)) {
    const bool second = is_within(1, byte(0) == 0xE0 ? 0xA0 : 0x80, byte(0) == 0xED ? 0x9F : 0xBF);
    return second && follows(2) ? 3 : 0;
  }
  if (is_within(0, 0xF0, 0xF4)) {
    const bool second = is_within(1, byte(0) == 0xF0 ? 0x90 : 0x80, byte(0) == 0xF4 ? 0x8F : 0xBF);
    return second && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

std::size_t FindInvalidUtf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = Utf8Length(text.substr(at));
    if (length == 0) break;
    at += length;
  }
  return at;
}

std::string EscapeInvalidUtf8(std::string_view text) {
  std::string escaped;
  while (true) {
    const std::size_t valid = FindInvalidUtf8(text);
    escaped += text.substr(0, valid);
    if (valid == text.size()) return escaped;
    escaped += Escaped(text[valid]);
    text.remove_prefix(valid + 1);
  }
}

std::string EscapeControls(std::string_view text) {
  const std::string valid = EscapeInvalidUtf8(text);
  std::string escaped;
  for (std::size_t at = 0; at < valid.size();) {
    const std::size_t length = Utf8Length(std::string_view(valid).substr(at));
    const std::string character = valid.substr(at, length);
    at += length;
    const auto first = static_cast<unsigned char>(character.front());
    const bool is_layout = first == '\n' || first == '\t' || first == '\r';
    const bool is_upper_control = first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
    const bool is_control = (first < 0x20 && !is_layout) || first == 0x7F || is_upper_control;
    for (const char c : character) escaped += is_control ? Escaped(c) : std::string(1, c);
  }
  return escaped;
}

std::string Utf8Prefix(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return std::string(text);
  std::size_t end = 0;
  while (true) {
    const std::size_t length = std::max<std::size_t>(1, Utf8Length(text.substr(end)));
    if (end + length > max_bytes) return std::string(text.substr(0, end));
    end += length;
  }
}

}  // namespace sidestep
