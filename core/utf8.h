#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sidestep {

/// Bytes of the character that `text` begins with; 0 if it does not begin with well-formed UTF-8
/// (overlong forms, surrogates and what lies above U+10FFFF are not). Source: The Unicode Standard
/// 15, table 3-7.
std::size_t Utf8Length(std::string_view text);

/// Where the first byte stands that belongs to no character; text.size() if there is none.
std::size_t FindInvalidUtf8(std::string_view text);

/// `text` with every byte that belongs to no character written out, e.g. `\xE9`. Names of files and
/// arguments may hold any bytes; what is printed, or stored in a format of text, may not.
std::string EscapeInvalidUtf8(std::string_view text);

/// `text` fit for a terminal: what EscapeInvalidUtf8 writes out, and control characters too, which
/// could move the cursor or change what is shown: those below U+0020 but for line ends, tabs and
/// returns, U+007F, and U+0080 to U+009F; e.g. `\x1B`.
std::string EscapeControls(std::string_view text);

/// At most the first `max_bytes` bytes, and no part of a character.
std::string Utf8Prefix(std::string_view text, std::size_t max_bytes);

}  // namespace sidestep
