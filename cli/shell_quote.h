#pragma once

#include <string>

namespace sidestep::cli {

/// `text` as one word of a POSIX shell, in ASCII: as it stands where that needs no quotes, else in
/// '...', or in $'...' (bash, ksh, zsh) where it holds bytes that are not printable ASCII.
std::string ShellQuoted(const std::string& text);

}  // namespace sidestep::cli
