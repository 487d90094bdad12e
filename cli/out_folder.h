#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {

/// The folder that --out names, made if it is not there, before the work whose results it is to
/// hold. @throws InputError if it cannot be made, or cannot take one of `files`.
inline std::string MakeOutFolder(const std::string& out, const std::vector<std::string>& files) {
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error || !std::filesystem::is_directory(out)) {
    throw InputError(
        "--out", "'" + out + "' cannot be made a folder" + (error ? ": " + error.message() : ""));
  }
  for (const std::string& file : files) CheckCanWrite(out + "/" + file);
  return out;
}

}  // namespace sidestep::cli
