#include "tests/architecture_rules.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

#include "tests/defined_types.h"

namespace sidestep {
namespace {

using Names = std::set<std::string>;

const Names kOtherFolders = {"cmake", "docs", "examples", "models", "tests", ".ci", ".github"};
const std::string kPrefix = "sidestep/";  // of the headers of modules
const std::string kBeforeAPath = " \t\n\"'`=:(,[<";

// What is done in one place only, and where.
struct Craft {
  std::string word;   // that gives it away
  std::string place;  // the files that may, without their endings
  std::string what;
};
const std::vector<Craft> kCrafts = {
    {"std::ofstream", "core/atomic_file", "writes a file"},
    {"fopen(", "core/atomic_file", "writes a file"},
    {"avio_open", "core/atomic_file", "writes a file"},
    {"snprintf(", "core/number_text", "formats numbers"},
    {"std::to_chars", "core/number_text", "formats numbers"},
    {"std::printf(", "cli/console", "prints"},
    {"std::fprintf(", "cli/console", "prints"},
    {"std::cout", "cli/console", "prints"},
    {"system_clock", "cli/operator_log", "asks for the time of day"},
    {"std::time(", "cli/operator_log", "asks for the time of day"},
    {"CLOCK_REALTIME", "cli/operator_log", "asks for the time of day"},
    {"gettimeofday(", "cli/operator_log", "asks for the time of day"},
};
// Random numbers of the C++ library and of Eigen.
const Names kForeignRandom = {"<random>",           "_distribution<",
                              "std::mt19937",       "std::minstd_",
                              "std::ranlux",        "std::default_random_engine",
                              "std::shuffle",       "std::ranges::shuffle",
                              "std::random_device", "std::rand(",
                              "::Random(",          "setRandom("};
// Programs of their own, and what grows on the disk as the work goes on.
const Names kOutsideTheCrafts = {"bench/micro/", "bench/peers/", "record/journal."};

bool StartsWith(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

bool EndsWith(std::string_view text, std::string_view suffix) {
  return text.size() >= suffix.size() && text.substr(text.size() - suffix.size()) == suffix;
}

bool Holds(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

std::string TopFolder(const std::string& path) {
  const std::size_t slash = path.find('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

struct Include {
  int line = 0;
  bool quoted = false;
  std::string name;
};

std::vector<Include> Includes(const std::string& text) {
  std::vector<Include> includes;
  const std::vector<std::string> lines = Lines(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::istringstream words(lines[i]);
    std::string hash, name;
    words >> hash;
    if (hash == "#") words >> name;
    if (hash + name != "#include") continue;
    words >> name;
    const std::size_t end = name.find_first_of(">\"", 1);
    if (end == std::string::npos) continue;
    includes.push_back({static_cast<int>(i) + 1, name[0] == '"', name.substr(1, end - 1)});
  }
  return includes;
}

// What every module may include: the C++ library, whose names have neither a folder nor an ending,
// Eigen, and POSIX.
bool IsForEveryone(const std::string& name) {
  return name.find_first_of("./") == std::string::npos || StartsWith(name, "Eigen/") ||
         StartsWith(name, "sys/") || name == "unistd.h" || name == "fcntl.h";
}

class Checker {
 public:
  Checker(const SourceTree& tree, const std::vector<ModuleRule>& rules)
      : tree_(tree), rules_(rules) {}

  std::vector<std::string> Run() {
    CheckTopLevel();
    for (const auto& [path, text] : tree_) {
      CheckNoMachinePath(path, text);
      CheckRandomNumbers(path, text);
      if (EndsWith(path, ".h") && text.find("#pragma once") == std::string::npos) {
        Complain(path, "a header without #pragma once");
      }
    }
    for (const ModuleRule& rule : rules_) CheckModule(rule);
    CheckOthers();
    CheckTypes();
    return violations_;
  }

 private:
  void Complain(const std::string& path, const std::string& why) {
    violations_.push_back(path + ": " + why);
  }
  void Complain(const std::string& path, int line, const std::string& why) {
    Complain(path + ":" + std::to_string(line), why);
  }
  bool IsModule(const std::string& name) const {
    return std::any_of(rules_.begin(), rules_.end(),
                       [&](const ModuleRule& rule) { return rule.name == name; });
  }

  void CheckTopLevel() {
    Names folders;
    for (const auto& [path, text] : tree_) folders.insert(TopFolder(path));
    folders.erase("");
    for (const std::string& folder : folders) {
      if (!IsModule(folder) && kOtherFolders.count(folder) == 0) {
        Complain(folder, "a folder at the top that is no module; see docs/architecture.md");
      }
    }
  }

  void CheckNoMachinePath(const std::string& path, const std::string& text) {
    // Put together here, so that this file does not name them itself.
    for (const std::string folder : {"work", "home", "root"}) {
      const std::string prefix = "/" + folder + "/";
      for (std::size_t at = text.find(prefix); at != std::string::npos;
           at = text.find(prefix, at + 1)) {
        const bool begins_a_path = at == 0 || kBeforeAPath.find(text[at - 1]) != std::string::npos;
        if (!begins_a_path) continue;
        const auto end = text.begin() + static_cast<std::ptrdiff_t>(at);
        const auto line = std::count(text.begin(), end, '\n') + 1;
        Complain(path, static_cast<int>(line), "names a folder of one machine, " + prefix);
      }
    }
  }

  // What these give is each library's own, or a state that all share; what a run or a test draws
  // must be the same everywhere.
  void CheckRandomNumbers(const std::string& path, const std::string& text) {
    if (!(EndsWith(path, ".h") || EndsWith(path, ".cc"))) return;
    if (StartsWith(path, "tests/architecture_")) return;  // these name what they look for
    const std::vector<std::string> lines = Lines(text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto is_named = [&](const std::string& word) {
        return lines[i].find(word) != std::string::npos;
      };
      if (std::any_of(kForeignRandom.begin(), kForeignRandom.end(), is_named)) {
        Complain(path, static_cast<int>(i) + 1, "random numbers come from core/random.h");
      }
    }
  }

  void CheckModule(const ModuleRule& rule) {
    Names in_headers, in_all;
    for (const auto& [path, text] : tree_) {
      if (TopFolder(path) != rule.name || !(EndsWith(path, ".h") || EndsWith(path, ".cc")))
        continue;
      CheckCrafts(path, text);
      for (const Include& include : Includes(text)) {
        CheckInclude(rule, path, include);
        const std::string used = TopFolder(PathOf(include));
        if (!include.quoted || used == rule.name || !IsModule(used)) continue;
        in_all.insert(used);
        if (EndsWith(path, ".h")) in_headers.insert(used);
      }
    }
    CheckLinks(rule, in_headers, in_all);
  }

  void CheckCrafts(const std::string& path, const std::string& text) {
    for (const std::string& prefix : kOutsideTheCrafts) {
      if (StartsWith(path, prefix)) return;
    }
    for (const Craft& craft : kCrafts) {
      const std::size_t at = text.find(craft.word);
      if (at == std::string::npos || StartsWith(path, craft.place + ".")) continue;
      const auto end = text.begin() + static_cast<std::ptrdiff_t>(at);
      const auto line = std::count(text.begin(), end, '\n') + 1;
      Complain(path, static_cast<int>(line),
               craft.what + " by " + craft.word + "; " + craft.place + ".h is there for it");
    }
  }

  void CheckInclude(const ModuleRule& rule, const std::string& path, const Include& include) {
    if (include.quoted) {
      const std::string used = TopFolder(PathOf(include));
      if (CheckExists(path, include) && used != rule.name && !Holds(rule.modules, used)) {
        Complain(path, include.line, rule.name + "/ may not include " + include.name);
      }
      return;
    }
    const auto begins = [&](const std::string& library) {
      return StartsWith(include.name, library);
    };
    if (IsForEveryone(include.name)) return;
    if (std::none_of(rule.libraries.begin(), rule.libraries.end(), begins)) {
      Complain(path, include.line, rule.name + "/ may not include <" + include.name + ">");
    }
  }

  // Where in the tree a quoted name lies; empty where it does not begin as such names do.
  static std::string PathOf(const Include& include) {
    if (StartsWith(include.name, kPrefix)) return include.name.substr(kPrefix.size());
    return StartsWith(include.name, "tests/") ? include.name : "";
  }

  bool CheckExists(const std::string& path, const Include& include) {
    const std::string used = PathOf(include);
    const bool exists = !used.empty() && tree_.count(used) + tree_.count(used + ".in") > 0 &&
                        (IsModule(TopFolder(used)) || used == include.name);
    if (!exists) {
      Complain(path, include.line,
               "no file " + include.name + " (quoted names begin with sidestep/<module>/)");
    }
    return exists;
  }

  // Tests and examples may use every module, by the same names.
  void CheckOthers() {
    for (const auto& [path, text] : tree_) {
      if (IsModule(TopFolder(path)) || !(EndsWith(path, ".h") || EndsWith(path, ".cc"))) continue;
      if (StartsWith(path, "tests/package/outside/")) continue;  // somebody else's project
      for (const Include& include : Includes(text)) {
        if (include.quoted) CheckExists(path, include);
      }
    }
  }

  // Two types of one name in one namespace break the rule of one definition, and no tool says so:
  // the linker takes either one's functions for both. A module's own lie in its own namespace.
  void CheckTypes() {
    std::map<std::string, std::string> where;
    for (const auto& [path, text] : tree_) {
      if (!(EndsWith(path, ".h") || EndsWith(path, ".cc"))) continue;
      const std::string module = TopFolder(path);
      // `import` is a word of C++20.
      const std::string space = module == "import" ? "imports" : module;
      const std::string home = module == "core" ? "sidestep::" : "sidestep::" + space + "::";
      for (const DefinedType& type : FindDefinedTypes(text)) {
        const auto [first, is_new] = where.insert({type.name, path});
        // Each test is a program of its own; only what it shares with others must be unique.
        if (!is_new && (EndsWith(path, ".h") || !StartsWith(path, "tests/"))) {
          Complain(path, type.line, type.name + " is defined in " + first->second + " too");
        }
        if (IsModule(module) && !StartsWith(type.name, home)) {
          Complain(path, type.line, type.name + " lies outside " + home);
        }
      }
    }
  }

  // Holds every `sidestep::<module>` in the module's CMake files against what its files include.
  void CheckLinks(const ModuleRule& rule, const Names& in_headers, const Names& in_all) {
    Names linked, linked_privately;
    for (const auto& [path, text] : tree_) {
      if (TopFolder(path) != rule.name || !EndsWith(path, "CMakeLists.txt")) continue;
      bool is_private = false;
      std::istringstream words(text);
      for (std::string word; words >> word;) {
        if (word == "PRIVATE_DEPENDS") is_private = true;
        if (word.find("DEPENDS") == 0) is_private = false;
        word.erase(word.find_last_not_of(')') + 1);
        if (!StartsWith(word, "sidestep::")) continue;
        const std::string module = word.substr(std::string("sidestep::").size());
        if (module == rule.name) continue;
        linked.insert(module);
        if (is_private) linked_privately.insert(module);
      }
    }
    const std::string file = rule.name + "/CMakeLists.txt";
    for (const std::string& module : linked) {
      if (in_all.count(module) == 0) Complain(file, "links " + module + ", which no file includes");
    }
    for (const std::string& module : in_all) {
      if (linked.count(module) == 0)
        Complain(file, "does not link " + module + ", which is included");
    }
    for (const std::string& module : linked_privately) {
      if (in_headers.count(module) != 0) {
        Complain(file, "links " + module + " privately, but a header includes it");
      }
    }
  }

  const SourceTree& tree_;
  const std::vector<ModuleRule>& rules_;
  std::vector<std::string> violations_;
};

}  // namespace

const std::vector<ModuleRule>& ModuleRules() {
  static const std::vector<ModuleRule> rules = {
      {"core", {}, {"yaml-cpp/", "fmt/", "fcntl.h"}},
      {"record", {"core"}, {"hdf5.h", "fmt/"}},
      {"robot", {"core"}, {"arpa/", "netinet/"}},
      {"sdf", {"core"}, {"hwy/", "tbb/"}},
      {"planner", {"core", "robot", "sdf"}, {"ceres/", "ompl/", "hwy/"}},
      {"control", {"core", "robot"}, {}},
      {"scenarios", {"core"}, {}},
      {"sim", {"core", "robot", "control", "scenarios"}, {"mujoco/", "tinyxml2.h"}},
      {"hardware",
       {"core", "robot", "control"},
       {"franka/", "librealsense2/", "apriltag/", "opencv2/"}},
      {"bench",
       {"core", "record", "robot", "sdf", "planner", "control", "scenarios"},
       {"nlohmann/", "sqlite3.h", "benchmark/", "hwy/", "itk", "fmt/"}},
      {"render",
       {"core", "record", "robot", "scenarios", "sim"},
       {"mujoco/", "GL/", "libavcodec/", "libavformat/", "libavutil/", "libswscale/", "nlohmann/"}},
      {"import",
       {"core", "robot", "sdf", "scenarios"},
       {"urdf_parser/", "urdf_model/", "console_bridge/", "assimp/", "libqhull_r/", "fmt/",
        "tinyxml2.h"}},
      {"cli",
       {"core", "record", "robot", "sdf", "planner", "control", "scenarios", "sim", "hardware",
        "bench", "render", "import"},
       {"CLI/", "nlohmann/", "gnu/libc-version.h", "elf.h", "link.h", "malloc.h", "fmt/"}},
  };
  return rules;
}

SourceTree ReadSourceTree(const std::filesystem::path& root) {
  namespace fs = std::filesystem;
  SourceTree tree;
  for (auto it = fs::recursive_directory_iterator(root); it != fs::end(it); ++it) {
    const std::string path = it->path().lexically_relative(root).generic_string();
    if (it->is_directory()) {
      const std::string name = it->path().filename().string();
      const bool hidden = name[0] == '.' && path != ".ci" && path != ".github";
      if (hidden || path == "build" || path == "out") it.disable_recursion_pending();
      continue;
    }
    if (path == ".git") continue;  // a worktree's points to its repository
    if (!it->is_regular_file()) continue;
    std::ifstream stream(it->path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (text.find('\0') == std::string::npos) tree[path] = text;
  }
  return tree;
}

std::vector<std::string> FindViolations(const SourceTree& tree,
                                        const std::vector<ModuleRule>& rules) {
  return Checker(tree, rules).Run();
}

}  // namespace sidestep
