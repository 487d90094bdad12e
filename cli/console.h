#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <utility>

namespace sidestep::cli {

/// Everything that commands say goes through here, so that a terminal gets text: bytes that are not
/// UTF-8, as the name of a file may hold, and control characters are written out (core/utf8.h).
/// @throws InputError if standard output cannot take it, as on a full disk. That a reader has gone
/// away, `| head`, is no error.
void PrintText(std::string_view text);       // standard output
void PrintErrorText(std::string_view text);  // standard error

template <typename... Values>
void Print(fmt::format_string<Values...> format, Values&&... values) {
  PrintText(fmt::format(format, std::forward<Values>(values)...));
}
template <typename... Values>
void PrintError(fmt::format_string<Values...> format, Values&&... values) {
  PrintErrorText(fmt::format(format, std::forward<Values>(values)...));
}

/// Text of a file, which may hold line ends, in one line: spaces instead, and none at the end.
std::string OneLine(std::string text);

/// Call once a command is done: hands on what is still held back. @throws InputError as PrintText.
void FinishOutput();

}  // namespace sidestep::cli
