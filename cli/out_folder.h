#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
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

/// The same for work that may be refused yet: what was made and holds nothing in the end goes
/// again.
class OutFolder {
 public:
  OutFolder(const std::string& out, const std::vector<std::string>& files) : path_(out) {
    namespace fs = std::filesystem;
    std::error_code error;
    for (fs::path folder = out; !folder.empty() && !fs::exists(folder, error);
         folder = folder.parent_path()) {
      made_.push_back(folder);
    }
    try {
      MakeOutFolder(out, files);
    } catch (...) {
      RemoveEmpty();
      throw;
    }
  }
  ~OutFolder() { RemoveEmpty(); }
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  void RemoveEmpty() const {
    std::error_code error;  // one that holds something stays
    for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, error);
  }

  std::string path_;
  std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace sidestep::cli
