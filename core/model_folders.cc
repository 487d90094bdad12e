#include "sidestep/core/model_folders.h"

#include <filesystem>
#include <set>

namespace sidestep {

namespace fs = std::filesystem;

std::optional<std::string> ModelFolders::Find(const std::string& name) const {
  std::error_code error;
  for (const std::string& folder : folders_) {
    const std::string path = folder + "/" + name;
    if (fs::is_directory(path, error)) return path;
  }
  return std::nullopt;
}

std::vector<std::string> ModelFolders::NamesWith(const std::string& file) const {
  std::set<std::string> names;
  for (const std::string& folder : folders_) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      const std::string name = entry.path().filename().string();
      const std::size_t star = file.find('*');
      const std::string own =
          star == std::string::npos ? file : file.substr(0, star) + name + file.substr(star + 1);
      if (fs::exists(entry.path() / own, error)) names.insert(name);
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace sidestep
