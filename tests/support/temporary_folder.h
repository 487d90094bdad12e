#pragma once

#include <stdlib.h>  // mkdtemp is POSIX's, not <cstdlib>'s

#include <filesystem>
#include <stdexcept>
#include <string>

namespace sidestep {

/// An empty folder of one test's own, gone with all that is in it at the end of its scope. Tests
/// run at the same time as others of their program, so that a fixed name would be shared.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "sidestep_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace sidestep
