#include "tests/package/installation.h"

#include <cstdlib>
#include <stdexcept>

namespace sidestep {

namespace fs = std::filesystem;

Installation::Installation() {
  unsetenv("SIDESTEP_DATA_DIR");
  std::string name = (fs::temp_directory_path() / "sidestep_package_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = name;
  fs::create_directory(folder_ / "elsewhere");
}

Installation::~Installation() { fs::remove_all(folder_); }

Finished Installation::Install(const std::string& component) const {
  return RunProgram({CMAKE_PROGRAM, "--install", SIDESTEP_BUILD_DIR, "--prefix", prefix().string(),
                     "--component", component});
}

Finished Installation::Run(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), (prefix() / "bin/sidestep").string());
  return RunProgram(arguments, {}, (folder_ / "elsewhere").string());
}

}  // namespace sidestep
