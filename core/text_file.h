#pragma once

#include <cstdint>
#include <string>

namespace sidestep {

/// `bytes` as text in one form, whatever editor they come from: UTF-8 without a byte-order mark,
/// lines ended by LF (a CR before it is dropped).
/// @param name stands for the file in messages.
/// @throws InputError `NAME:LINE: WHY` for UTF-16, UTF-32, Latin-1 and all else that is not UTF-8.
std::string DecodeText(const std::string& bytes, const std::string& name);

/// Reads a text file; every reader of texts begins here.
/// @throws InputError if it is missing, a directory or another thing than a file, longer than
/// `max_bytes`, or as DecodeText says.
std::string ReadTextFile(const std::string& path, std::uintmax_t max_bytes);

}  // namespace sidestep
