#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "sidestep/core/input_error.h"

namespace sidestep::cli {

/// The folder that --out names, made if it is not there. @throws InputError if it cannot be.
inline std::string MakeOutFolder(const std::string& out) {
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error || !std::filesystem::is_directory(out)) {
    throw InputError("--out", "'" + out + "' cannot be made a folder");
  }
  return out;
}

}  // namespace sidestep::cli
