#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sidestep {

/// Where robots, and bodies to be drawn, are looked for: folders that hold one folder for each,
/// named after it. Of two with the same name, the one of the folder that comes first counts.
class ModelFolders {
 public:
  ModelFolders(std::vector<std::string> folders) : folders_(std::move(folders)) {}
  ModelFolders(std::string folder) : folders_{std::move(folder)} {}
  ModelFolders(const char* folder) : folders_{folder} {}

  const std::vector<std::string>& folders() const { return folders_; }

  /// The first folder of this name that is there.
  std::optional<std::string> Find(const std::string& name) const;
  /// The names of those that hold such a file, sorted; `*` of the file stands for the name.
  std::vector<std::string> NamesWith(const std::string& file) const;

 private:
  std::vector<std::string> folders_;
};

}  // namespace sidestep
