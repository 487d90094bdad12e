#include "sidestep/sim/mesh_files.h"

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/sim/geom_solids.h"
#include "sidestep/sim/mesh_corners.h"
#include "sidestep/sim/mesh_vertices.h"
#include "sidestep/sim/mjcf_tags.h"
#include "sidestep/sim/mujoco_model.h"

namespace sidestep::sim {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

constexpr std::size_t kMostCorners = 1000;  // of one mesh

// The element that a tag begins, by itself. @return nullptr if it is none.
const XMLElement* ParseTag(std::string_view xml, const XmlTag& tag,
                           tinyxml2::XMLDocument* document) {
  std::string text(xml.substr(tag.begin, tag.end - tag.begin));
  if (text[text.size() - 2] != '/') text.insert(text.size() - 1, "/");
  return document->Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS
             ? document->RootElement()
             : nullptr;
}

class Inliner {
 public:
  Inliner(const std::string& xml, const std::string& path)
      : xml_(xml), path_(path), folder_(fs::path(path).parent_path()) {
    XmlTag tag;
    for (std::size_t from = 0; FindTag(xml_, "compiler", from, &tag); from = tag.end) {
      tinyxml2::XMLDocument document;
      const XMLElement* const compiler = ParseTag(xml_, tag, &document);
      if (compiler == nullptr || compiler->Attribute("meshdir") == nullptr) continue;
      folder_ = CheckedPath(tag, "compiler", compiler->Attribute("meshdir"));
    }
  }

  std::string Run() {
    std::string text;
    std::size_t done = 0;
    XmlTag tag;
    while (FindTag(xml_, "mesh", done, &tag)) {
      text += xml_.substr(done, tag.begin - done);
      done = tag.end;
      const std::string whole = xml_.substr(tag.begin, tag.end - tag.begin);
      tinyxml2::XMLDocument document;
      const XMLElement* const mesh = ParseTag(xml_, tag, &document);
      const bool is_file = mesh != nullptr && mesh->Attribute("file") != nullptr;
      text += is_file ? Inlined(tag, *mesh, whole) : whole;
    }
    return text + xml_.substr(done);
  }

 private:
  [[noreturn]] void Fail(const XmlTag& tag, const std::string& key, const std::string& why) const {
    const auto begin = xml_.begin();
    const auto line = 1 + std::count(begin, begin + static_cast<std::ptrdiff_t>(tag.begin), '\n');
    throw InputError(path_, static_cast<int>(line), key, why);
  }

  // In the model's folder or below it: a model is whole by itself.
  fs::path CheckedPath(const XmlTag& tag, const std::string& key, const fs::path& file) const {
    const fs::path plain = file.lexically_normal();
    if (plain.is_absolute() || (!plain.empty() && *plain.begin() == "..")) {
      Fail(tag, key, "'" + file.string() + "' must lie in the model's folder");
    }
    return folder_ / plain;
  }

  std::string Inlined(const XmlTag& tag, const XMLElement& mesh, const std::string& whole) const {
    const std::string file = mesh.Attribute("file");
    const fs::path path = CheckedPath(tag, "mesh", file);
    std::error_code error;
    if (!fs::is_regular_file(path, error)) Fail(tag, "mesh", "there is no " + path.string());
    const char* const given = mesh.Attribute("name");
    const std::string name = given != nullptr ? given : path.stem().string();
    std::string vertices;
    try {
      vertices = CornersOf(mesh, fs::absolute(path).string());
    } catch (const std::exception& why) {
      Fail(tag, "mesh '" + name + "'", file + ": " + why.what());
    }
    tinyxml2::XMLDocument document;
    XMLElement* const inlined = document.NewElement("mesh");
    document.InsertEndChild(inlined);
    inlined->SetAttribute("name", name.c_str());
    inlined->SetAttribute("vertex", vertices.c_str());
    tinyxml2::XMLPrinter printer(nullptr, /*compact=*/true);
    document.Print(&printer);
    std::string text = printer.CStr();
    if (whole[whole.size() - 2] != '/') text.erase(text.size() - 2, 1);  // a </mesh> follows
    const auto lines = std::count(whole.begin(), whole.end(), '\n');
    return text + std::string(static_cast<std::size_t>(lines), '\n');
  }

  // Of the hull, as MuJoCo has it, to the micrometre.
  static std::string CornersOf(const XMLElement& mesh, const std::string& path) {
    const Eigen::Matrix3Xd corners = ScaleOf(mesh).asDiagonal() * ReadMeshCorners(path);
    CheckMeshVertices(corners);
    const MujocoModelPtr model = LoadMujocoModel(
        "<mujoco><asset><mesh name=\"mesh\" vertex=\"" + ToText(corners) +
            "\"/></asset><worldbody><geom type=\"mesh\" mesh=\"mesh\"/></worldbody></mujoco>",
        "MuJoCo");
    // MuJoCo turns a mesh into its principal axes, and the geom against that.
    const mjtNum* const q = model->geom_quat;
    const Eigen::Quaterniond R(q[0], q[1], q[2], q[3]);
    const Eigen::Map<const Eigen::Vector3d> p(model->geom_pos);
    const ConvexHull hull = HullOfMesh(*model, 0);
    if (hull.vertices.size() > kMostCorners) {
      throw InputError("its hull has " + std::to_string(hull.vertices.size()) + " corners",
                       "must be at most " + std::to_string(kMostCorners));
    }
    Eigen::Matrix3Xd placed(3, static_cast<Eigen::Index>(hull.vertices.size()));
    for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
      placed.col(static_cast<Eigen::Index>(i)) = R * hull.vertices[i] + p;
    }
    return ToText((placed * 1e6).array().round().matrix() / 1e6);
  }

  static Eigen::Vector3d ScaleOf(const XMLElement& mesh) {
    Eigen::Vector3d scale(1, 1, 1);
    for (const tinyxml2::XMLAttribute* attribute = mesh.FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next()) {
      const std::string_view key = attribute->Name();
      if (key == "name" || key == "file") continue;
      std::istringstream words(attribute->Value());
      if (key != "scale") throw InputError(std::string(key), "is not taken");
      words >> scale.x() >> scale.y() >> scale.z();
      if (!words) throw InputError("scale", "must be three numbers");
    }
    return scale;
  }

  static std::string ToText(const Eigen::Matrix3Xd& points) {
    std::string text;
    for (const double value : points.reshaped()) {
      text += (text.empty() ? "" : " ") + ShortestNumber(value);
    }
    return text;
  }

  const std::string& xml_;
  const std::string& path_;
  fs::path folder_;
};

}  // namespace

std::string InlineMeshFiles(const std::string& xml, const std::string& path) {
  return Inliner(xml, path).Run();
}

}  // namespace sidestep::sim
