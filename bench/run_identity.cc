#include "sidestep/bench/run_identity.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "sidestep/core/fingerprint.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

namespace fs = std::filesystem;

void AddFile(const fs::path& path, Fingerprint& fingerprint) {
  std::ifstream stream(path, std::ios::binary);
  fingerprint.Add(std::string(std::istreambuf_iterator<char>(stream), {}));
  if (!stream) throw InputError(path.string(), "cannot be read");
}

void AddFolder(const fs::path& folder, Fingerprint& fingerprint) {
  std::map<std::string, fs::path> files;  // a folder has no order of its own
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (!entry->is_regular_file()) continue;
    files[entry->path().lexically_relative(folder).generic_string()] = entry->path();
  }
  if (error) throw InputError(folder.string(), "cannot be read");
  for (const auto& [name, path] : files) {
    fingerprint.Add(name);
    AddFile(path, fingerprint);
  }
}

}  // namespace

RunIdentity IdentifyRun(const scenarios::Scenario& scenario, const ModelFolders& models,
                        const std::string& build) {
  Fingerprint text, files;
  text.Add(scenarios::ToYaml(scenario));
  // They stand in a trace too, even where they change nothing of the scenario.
  for (const auto& [choice, chosen] : scenario.choices) {
    text.Add(choice);
    text.Add(chosen);
  }
  for (const auto& [key, value] : scenario.drawn) {
    text.Add(key);
    text.Add(ShortestText(value));
  }
  std::set<std::pair<std::string, std::string>> folders;  // by name
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    const std::string& name = obstacle.appearance;
    if (!name.empty()) folders.emplace(name, models.Find(name).value_or(name));
  }
  if (!scenario.robot.empty()) folders.emplace(scenario.robot, RobotFolder(scenario, models));
  for (const auto& [name, folder] : folders) {
    files.Add(name);
    AddFolder(folder, files);
  }
  return {text.Text(), files.Text(), build, ""};
}

std::string RunId(const RunIdentity& identity) {
  Fingerprint all;
  for (const std::string& part :
       {identity.scenario, identity.models, identity.build, identity.method}) {
    all.Add(part);
  }
  return all.Text();
}

}  // namespace sidestep::bench
