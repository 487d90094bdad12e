#include "tests/package/installation.h"

#include <cstdlib>

namespace sidestep {

namespace fs = std::filesystem;

Installation::Installation() {
  unsetenv("SIDESTEP_DATA_DIR");
  fs::create_directory(folder() / "elsewhere");
}

Finished Installation::Install(const std::string& component) const {
  return RunProgram({CMAKE_PROGRAM, "--install", SIDESTEP_BUILD_DIR, "--prefix", prefix().string(),
                     "--component", component});
}

Finished Installation::Run(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), (prefix() / "bin/sidestep").string());
  return RunProgram(arguments, {}, (folder() / "elsewhere").string());
}

}  // namespace sidestep
