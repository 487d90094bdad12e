#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/subprocess.h"

namespace sidestep {

/// A folder of its own, gone afterwards, and what is installed below it.
class Installation {
 public:
  Installation();
  ~Installation();
  Installation(const Installation&) = delete;
  Installation& operator=(const Installation&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path prefix() const { return folder_ / "prefix"; }

  /// `cmake --install` of one component ("command", "development") into prefix().
  Finished Install(const std::string& component) const;

  /// Runs the installed command in an empty folder of its own, data folder not set.
  Finished Run(std::vector<std::string> arguments) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace sidestep
