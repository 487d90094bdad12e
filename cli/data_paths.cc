#include "sidestep/cli/data_paths.h"

#include <cstdlib>
#include <filesystem>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

bool HoldsData(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "models", error) &&
         fs::is_directory(folder / "scenarios", error);
}

DataPaths In(const fs::path& folder) {
  return {(folder / "models").string(), (folder / "scenarios").string()};
}

DataPaths FindOwnPaths() {
  if (const char* chosen = std::getenv("SIDESTEP_DATA_DIR")) {
    if (HoldsData(chosen)) return In(chosen);
    throw InputError("SIDESTEP_DATA_DIR",
                     std::string("'") + chosen + "' does not hold models/ and scenarios/");
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "sidestep";
  if (!error && HoldsData(installed)) return In(installed);
  if (HoldsData(SIDESTEP_SOURCE_DIR)) return In(SIDESTEP_SOURCE_DIR);
  throw InputError("sidestep", "no models/ and scenarios/ found; set SIDESTEP_DATA_DIR");
}

}  // namespace

ModelFolders DataPaths::all_models() const {
  std::vector<std::string> folders = more_models;
  folders.push_back(models);
  return folders;
}

DataPaths FindDataPaths(const std::vector<std::string>& more_models) {
  DataPaths paths = FindOwnPaths();
  for (const std::string& folder : more_models) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
      throw InputError("--models", "'" + folder + "' is no folder");
    }
    const ModelFolders models(folder);
    if (models.NamesWith("robot.yaml").empty() && models.NamesWith("*.xml").empty()) {
      throw InputError("--models", "'" + folder + "' holds no robot (NAME/robot.yaml)");
    }
  }
  paths.more_models = more_models;
  return paths;
}

std::string FindScenario(const std::string& scenario, const DataPaths& paths) {
  const bool is_path = scenario.find('/') != std::string::npos ||
                       (scenario.size() > 5 && scenario.ends_with(".yaml"));
  if (is_path) return scenario;
  const fs::path file = fs::path(paths.scenarios) / (scenario + ".yaml");
  std::error_code error;
  if (fs::exists(file, error)) return file.string();
  throw InputError("SCENARIO", "'" + scenario + "' is no scenario (known: " +
                                   Joined(scenarios::ScenarioNames(paths.scenarios)) +
                                   "; a path needs a / or ends in .yaml)");
}

}  // namespace sidestep::cli
