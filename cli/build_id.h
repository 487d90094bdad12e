#pragma once

#include <string>

namespace sidestep::cli {

/// The id that the linker gave this program, in hexadecimal digits: a hash of all that it is made
/// of, so that a program built from changed sources has another one, whatever git says.
/// @throws std::logic_error if the program was linked without --build-id.
std::string BuildId();

}  // namespace sidestep::cli
