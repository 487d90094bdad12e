#include "sidestep/robot/variant_names.h"

#include <algorithm>
#include <filesystem>

#include "sidestep/core/input_error.h"
#include "sidestep/core/yaml_reader.h"

namespace sidestep::robot {

std::vector<std::string> VariantNames(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  std::error_code error;
  const std::string robot = fs::path(folder).filename().string();
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".yaml") continue;
    try {
      if (!YamlReader::FromFile(entry.path().string()).Has("extends")) continue;
    } catch (const InputError&) {  // whoever asks for it by name is told
      continue;
    }
    names.push_back(robot + ":" + entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace sidestep::robot
