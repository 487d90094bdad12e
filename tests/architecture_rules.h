#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sidestep {

/// One module and what its files may include beside itself, the C++ library, POSIX and Eigen.
struct ModuleRule {
  std::string name;
  std::vector<std::string> modules;
  /// Beginnings of the names in angle brackets, e.g. "ceres/", "hdf5.h".
  std::vector<std::string> libraries;
};

/// The arrows between modules; docs/architecture.md says the same in prose.
const std::vector<ModuleRule>& ModuleRules();

/// The text files of a repository, by their path from its root with '/' between folders.
using SourceTree = std::map<std::string, std::string>;

/// Reads every text file below `root`, except what git ignores: build/, out/ and hidden folders
/// other than .ci.
SourceTree ReadSourceTree(const std::filesystem::path& root);

/// What breaks the rules, one line each, `FILE:LINE: WHY` or `FILE: WHY`. Checked are:
///  - includes: module headers and libraries against `rules`; quoted names as they are installed,
///    "sidestep/<module>/<file>", but for those of tests/;
///  - links: a module's CMakeLists.txt names exactly the modules that its files include, and those
///    that its headers include are not private;
///  - headers: `#pragma once`;
///  - types: none of one name twice in a namespace, and each in that of its module;
///  - crafts: modules write files, format numbers and print in one place each;
///  - the top level: no folder but the modules and a few known ones;
///  - random numbers: no distribution of the C++ library in a module;
///  - paths: no file names a folder that only one machine has.
std::vector<std::string> FindViolations(const SourceTree& tree,
                                        const std::vector<ModuleRule>& rules);

}  // namespace sidestep
