#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
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
      Leave();
      throw;
    }
  }
  ~OutFolder() { Leave(); }
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;

  const std::string& path() const { return path_; }

  /// For files that are worth nothing one without the other: as long as this lives, nobody else
  /// gets the lock. Where folders cannot be locked, as on some network file systems, goes on
  /// without. @throws InputError if another command has it.
  void Lock() {
    folder_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_ >= 0 && flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      throw InputError("--out", "'" + path_ + "': another command is writing here just now");
    }
  }

 private:
  void Leave() const {
    std::error_code error;  // one that holds something stays
    for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, error);
    if (folder_ >= 0) close(folder_);
  }

  std::string path_;
  int folder_ = -1;                          // open while it is locked
  std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace sidestep::cli
