#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {

/// A folder of its own, gone afterwards, and what is installed below it.
class Installation {
 public:
  Installation();

  const std::filesystem::path& folder() const { return folder_.path(); }
  std::filesystem::path prefix() const { return folder() / "prefix"; }

  /// `cmake --install` of one component ("command", "development") into prefix().
  Finished Install(const std::string& component) const;

  /// Runs the installed command in an empty folder of its own, data folder not set.
  Finished Run(std::vector<std::string> arguments) const;

 private:
  TemporaryFolder folder_;
};

}  // namespace sidestep
