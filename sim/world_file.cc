#include "sidestep/sim/world_file.h"

#include <tinyxml2.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sidestep/core/input_error.h"
#include "sidestep/core/markup.h"
#include "sidestep/core/text_file.h"
#include "sidestep/sim/mesh_vertices.h"

namespace sidestep::sim {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

constexpr std::size_t kMostWorldBytes = 64 << 20;
constexpr int kMostFiles = 100, kMostWorldElements = 20000;

// Made to any size from a few words.
const std::set<std::string_view> kRefusedInWorld = {"composite", "skin", "flexcomp", "plugin"};

// Attributes whose squares and products are allocated, and the most they may be.
constexpr std::pair<std::string_view, double> kWorldBounds[] = {
    {"width", 4096},    {"height", 4096},   {"nrow", 4096},      {"ncol", 4096},
    {"njmax", 8000},    {"nconmax", 8000},  {"nstack", 1e8},     {"nkey", 1000},
    {"nuserdata", 1e6}, {"offwidth", 8192}, {"offheight", 8192}, {"shadowsize", 16384}};

class WorldChecker {
 public:
  /// @param folder that included files are looked for in, as MuJoCo does: the first file's.
  explicit WorldChecker(fs::path folder) : folder_(std::move(folder)) {}

  void CheckFile(const std::string& path, bool is_first) {
    if (++num_files_ > kMostFiles) {
      throw InputError(path, "is one included file too many: they include each other");
    }
    const std::string xml = ReadTextFile(path, kMostWorldBytes);
    tinyxml2::XMLDocument document;
    if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
      throw XmlFault(path, document.ErrorLineNum(), document.ErrorName());
    }
    const XMLElement* const root = document.RootElement();
    if (root == nullptr || (is_first && std::string_view(root->Name()) != "mujoco")) {
      throw InputError(path, root == nullptr ? 1 : root->GetLineNum(), "",
                       "must be an MJCF file, whose root is <mujoco>");
    }
    Check(*root, path);
  }

 private:
  [[noreturn]] static void Fail(const XMLElement& element, const std::string& path,
                                std::string_view key, const std::string& why) {
    throw InputError(path, element.GetLineNum(), std::string(key), why);
  }

  void Check(const XMLElement& element, const std::string& path) {
    const std::string_view tag = element.Name();
    if (++num_elements_ > kMostWorldElements) {
      Fail(element, path, tag,
           "is one element too many, of at most " + std::to_string(kMostWorldElements));
    }
    if (kRefusedInWorld.count(tag) > 0) Fail(element, path, tag, "is not taken");
    for (const tinyxml2::XMLAttribute* attribute = element.FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next()) {
      CheckNumbers(element, path, *attribute);
    }
    if (tag == "mesh" && element.Attribute("vertex") != nullptr) CheckMesh(element, path);
    if (tag == "include") {
      const char* const file = element.Attribute("file");
      if (file == nullptr) Fail(element, path, "file", "is missing");
      CheckFile((folder_ / file).string(), false);
    }
    for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      Check(*child, path);
    }
  }

  // MuJoCo takes numbers that are none, and computes with them.
  static void CheckNumbers(const XMLElement& element, const std::string& path,
                           const tinyxml2::XMLAttribute& attribute) {
    const std::string_view key = attribute.Name();
    for (const auto& [name, most] : kWorldBounds) {
      if (key != name || std::strtod(attribute.Value(), nullptr) <= most) continue;
      Fail(element, path, key,
           "must be at most " + std::to_string(static_cast<int>(most)) + ", is " +
               attribute.Value());
    }
    if (key == "name" || key == "class" || key == "file" || key == "model") return;
    std::istringstream words(attribute.Value());
    for (std::string word; words >> word;) {
      char* end = nullptr;
      const bool is_finite = std::isfinite(std::strtod(word.c_str(), &end));
      if (*end != '\0') return;  // words
      if (!is_finite) Fail(element, path, key, "must be finite, is " + word);
    }
  }

  static void CheckMesh(const XMLElement& mesh, const std::string& path) {
    try {
      CheckMeshVertices(ReadMeshVertices(mesh.Attribute("vertex")));
    } catch (const InputError& error) {
      throw InputError(path + ":" + std::to_string(mesh.GetLineNum()), error.what());
    }
  }

  fs::path folder_;
  int num_files_ = 0, num_elements_ = 0;
};

}  // namespace

void CheckWorldFile(const std::string& path) {
  WorldChecker(fs::path(path).parent_path()).CheckFile(path, true);
}

}  // namespace sidestep::sim
