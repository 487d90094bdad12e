#include "sidestep/sim/foreign_model.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/core/markup.h"
#include "sidestep/core/text_file.h"
#include "sidestep/sim/mesh_files.h"
#include "sidestep/sim/mesh_vertices.h"

namespace sidestep::sim {
namespace {

using tinyxml2::XMLElement;

// Generous for a robot among some hundred things: a world of ours has some 20 kB and 300 elements.
constexpr std::size_t kMostForeignBytes = 2 << 20;
constexpr int kMostForeignElements = 5000, kMostJoints = 256;
constexpr double kMostTextureBytes = 256 << 20;

// What an attribute may be at most. MuJoCo's memory grows with their squares and products.
struct Bound {
  std::string_view tag, attribute;  // an empty attribute: all others of the element
  double most;
};
constexpr Bound kForeignBounds[] = {
    {"size", "njmax", 8000},  // so many doubles squared are allocated
    {"size", "nconmax", 8000},
    {"size", "", 100},
    {"texture", "width", 4096},  // all textures together: kMostTextureBytes
    {"texture", "height", 4096},
    {"global", "offwidth", 8192},  // pixels of the buffer that is drawn to
    {"global", "offheight", 8192},
    {"quality", "", 16384},  // of shadows, spheres, ...
    {"user", "dim", 1000},   // a sensor's values
};

// Made to any size from a few words, or of no use here: robots are made of primitives and convex
// meshes.
const std::set<std::string_view> kRefusedInForeign = {"composite", "hfield", "skin", "flexcomp",
                                                      "plugin"};

constexpr int kMostVertices = 20000;  // of all meshes

// The sections that BuildWorldXml writes or takes over from the robot.
const std::set<std::string_view> kSections = {
    "compiler",  "option",  "size",     "statistic", "visual",   "asset", "default",
    "worldbody", "contact", "equality", "tendon",    "actuator", "sensor"};

bool StartsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

class Walk {
 public:
  explicit Walk(const std::string& file) : file_(file) {}

  void Check(const XMLElement& element) {
    const std::string_view tag = element.Name();
    if (++num_elements_ > kMostForeignElements) {
      Fail(element, tag,
           "is one element too many, of at most " + std::to_string(kMostForeignElements));
    }
    if ((tag == "joint" || tag == "freejoint") && ++num_joints_ > kMostJoints) {
      Fail(element, tag, "is one joint too many, of at most " + std::to_string(kMostJoints));
    }
    if (tag == "include") Fail(element, tag, kNoFiles);
    for (const tinyxml2::XMLAttribute* attribute = element.FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next()) {
      // file, and fileright, fileup, ... of a sky
      if (StartsWith(attribute->Name(), "file")) Fail(element, attribute->Name(), kNoFiles);
      CheckBound(element, *attribute);
      CheckFinite(element, *attribute);
    }
    if (kRefusedInForeign.count(tag) > 0) Fail(element, tag, "is no part of a robot of ours");
    if (tag == "mesh") CheckMesh(element);
    if (tag == "texture") CountTexture(element);
    for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      Check(*child);
    }
  }

  [[noreturn]] void Fail(const XMLElement& element, std::string_view key,
                         const std::string& why) const {
    throw InputError(file_, element.GetLineNum(), std::string(key), why);
  }

 private:
  static constexpr const char* kNoFiles =
      "a model must not refer to other files, but for meshes in its folder";

  // What is no number is left to MuJoCo, which refuses it.
  void CheckBound(const XMLElement& element, const tinyxml2::XMLAttribute& attribute) const {
    for (const Bound& bound : kForeignBounds) {
      if (bound.tag != element.Name()) continue;
      if (!bound.attribute.empty() && bound.attribute != attribute.Name()) continue;
      if (std::strtod(attribute.Value(), nullptr) <= bound.most) return;
      Fail(element, attribute.Name(),
           "must be at most " + std::to_string(static_cast<int>(bound.most)) + ", is " +
               attribute.Value());
    }
  }

  // MuJoCo takes numbers that are none, and computes with them.
  void CheckFinite(const XMLElement& element, const tinyxml2::XMLAttribute& attribute) const {
    std::istringstream words(attribute.Value());
    bool is_numeric = true, is_finite = true;
    for (std::string word; words >> word;) {
      char* end = nullptr;
      is_finite = std::isfinite(std::strtod(word.c_str(), &end)) && is_finite;
      is_numeric = *end == '\0' && is_numeric;
    }
    const std::string_view key = attribute.Name();
    if (is_numeric && !is_finite && key != "name" && key != "class") {
      Fail(element, key, std::string("must be finite, is ") + attribute.Value());
    }
  }

  void CheckMesh(const XMLElement& mesh) {
    for (const tinyxml2::XMLAttribute* attribute = mesh.FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next()) {
      const std::string_view key = attribute->Name();
      if (key != "name" && key != "vertex") {
        Fail(mesh, key, "is not taken: a mesh is given by its name and the vertices of its hull");
      }
    }
    try {
      const Eigen::Matrix3Xd vertices = ReadMeshVertices(mesh.Attribute("vertex"));
      num_vertices_ += static_cast<int>(vertices.cols());
      if (num_vertices_ > kMostVertices) {
        throw InputError("vertex", "with it meshes would have more than " +
                                       std::to_string(kMostVertices) + " vertices");
      }
      CheckMeshVertices(vertices);
    } catch (const InputError& error) {
      throw InputError(file_ + ":" + std::to_string(mesh.GetLineNum()), error.what());
    }
  }

  // Six faces of three bytes a pixel, as a sky has them, made anew for each element.
  void CountTexture(const XMLElement& texture) {
    const double width = std::max(1.0, texture.DoubleAttribute("width", 0));
    const double height = std::max(width, texture.DoubleAttribute("height", 0));
    texture_bytes_ += 18 * width * height;
    if (texture_bytes_ > kMostTextureBytes) {
      Fail(texture, "texture", "with it textures would take more than 256 MiB of memory");
    }
  }

  const std::string& file_;
  int num_elements_ = 0, num_joints_ = 0, num_vertices_ = 0;
  double texture_bytes_ = 0;
};

}  // namespace

std::string ReadModelFile(const std::string& path) {
  const std::string xml = InlineMeshFiles(ReadTextFile(path, kMostForeignBytes), path);
  if (xml.size() <= kMostForeignBytes) return xml;
  throw InputError(path, "is " + std::to_string(xml.size()) +
                             " bytes long with its meshes, must be at most " +
                             std::to_string(kMostForeignBytes));
}

const XMLElement& ParseModel(const std::string& xml, const std::string& name,
                             tinyxml2::XMLDocument* document) {
  if (document->Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    throw XmlFault(name, document->ErrorLineNum(), document->ErrorName());
  }
  const XMLElement* const root = document->RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "mujoco") {
    throw InputError(name, root == nullptr ? 1 : root->GetLineNum(), "",
                     "must be an MJCF file, whose root is <mujoco>");
  }
  Walk(name).Check(*root);
  return *root;
}

MujocoModelPtr LoadModelFile(const std::string& path, ModelStore* store) {
  const std::string xml = ReadModelFile(path);
  tinyxml2::XMLDocument document;
  ParseModel(xml, path, &document);
  return store == nullptr ? LoadMujocoModel(xml, path) : store->Load(xml, path);
}

MujocoModelPtr LoadForeignModel(const std::string& xml, const std::string& name) {
  if (xml.size() > kMostForeignBytes) {
    throw InputError(name, "is " + std::to_string(xml.size()) + " bytes long, must be at most " +
                               std::to_string(kMostForeignBytes));
  }
  tinyxml2::XMLDocument document;
  const XMLElement& root = ParseModel(xml, name, &document);
  for (const XMLElement* section = root.FirstChildElement(); section != nullptr;
       section = section->NextSiblingElement()) {
    if (kSections.count(section->Name()) == 0) {
      throw InputError(name, section->GetLineNum(), section->Name(),
                       "is no section of a world of ours");
    }
  }
  try {
    return LoadMujocoModel(xml, name);
  } catch (const SimulationError& error) {
    throw InputError(name, error.what());
  }
}

}  // namespace sidestep::sim
