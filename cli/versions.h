#pragma once

#include <map>
#include <string>

namespace sidestep::cli {

/// "sidestep 0.1.0".
std::string VersionNumber();
/// "sidestep 0.1.0 (build abcdef123456)": the beginning of the build id (cli/build_id.h).
std::string VersionText();

/// What decides the bits of a run, beside its scenario: versions of the code, the compiler and the
/// libraries, and the variant of the C library that this CPU gets.
std::map<std::string, std::string> Versions();

}  // namespace sidestep::cli
