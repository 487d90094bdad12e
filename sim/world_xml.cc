#include "sidestep/sim/world_xml.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <set>
#include <utility>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/foreign_model.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/picture.h"

namespace sidestep::sim {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

std::string ToText(double value) { return ShortestText(value); }

template <typename Vector>
std::string ToText(const Eigen::MatrixBase<Vector>& values) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += (i > 0 ? " " : "") + ToText(static_cast<double>(values(i)));
  }
  return text;
}

void Set(XMLElement* element, const char* key, const std::string& value) {
  element->SetAttribute(key, value.c_str());
}

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

XMLElement* Append(XMLElement* parent, const char* tag, Attributes attributes = {}) {
  XMLElement* const element = parent->InsertNewChildElement(tag);
  for (const auto& [key, value] : attributes) Set(element, key, value);
  return element;
}

void SetPose(XMLElement* element, const Pose& X) {
  const Eigen::Quaterniond& q = X.rotation();
  Set(element, "pos", ToText(X.translation()));
  Set(element, "quat", ToText(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z())));
}

std::string MeshName(const std::string& obstacle) { return "mesh/" + obstacle; }

// The contact geom of an obstacle: `name` is both the geom's and, with "mesh/" before it, that of
// the mesh of a convex one.
void SetShape(XMLElement* geom, const Shape& shape, const std::string& name) {
  if (std::holds_alternative<ConvexMesh>(shape)) {
    Set(geom, "type", "mesh");
    Set(geom, "mesh", MeshName(name));
    return;
  }
  struct Size {
    std::string operator()(const Box& box) const { return ToText(box.size_m / 2); }
    std::string operator()(const Sphere& sphere) const { return ToText(sphere.radius_m); }
    std::string operator()(const Capsule& capsule) const {
      return ToText(Eigen::Vector2d(capsule.radius_m, capsule.length_m / 2));
    }
    std::string operator()(const Cylinder& cylinder) const {
      return ToText(Eigen::Vector2d(cylinder.radius_m, cylinder.length_m / 2));
    }
    std::string operator()(const Ellipsoid& ellipsoid) const {
      return ToText(ellipsoid.semi_axes_m);
    }
    std::string operator()(const ConvexMesh&) const { return ""; }
  };
  Set(geom, "type", ShapeName(shape));
  Set(geom, "size", std::visit(Size{}, shape));
}

// The robot's file -----------------------------------------------------------------------------

void CopyChildren(const XMLElement& from, XMLElement* to) {
  for (const tinyxml2::XMLNode* child = from.FirstChild(); child != nullptr;
       child = child->NextSibling()) {
    if (child->ToComment() == nullptr) to->InsertEndChild(child->DeepClone(to->GetDocument()));
  }
}

// Whether MJCF gives this element of a section defaults by its own `class`. (Bodies pass theirs on
// by `childclass`.)
bool TakesClass(const std::string& section, const std::string& tag) {
  if (section == "actuator" || section == "tendon" || section == "equality") return true;
  return (section == "asset" && tag == "material") || (section == "contact" && tag == "pair");
}

void MergeRobot(const scenarios::Scenario& scenario, const std::string& path, XMLElement* world) {
  XMLDocument document;
  const XMLElement& robot = ParseModel(ReadModelFile(path), path, &document);
  CheckArmFile(robot, path);
  const std::string main_class = scenario.robot + ".xml";
  const auto section = [&](const char* name) {
    XMLElement* found = world->FirstChildElement(name);
    return found != nullptr ? found : Append(world, name);
  };
  for (const XMLElement* from = robot.FirstChildElement(); from != nullptr;
       from = from->NextSiblingElement()) {
    const std::string name = from->Name();
    if (name == "compiler") {
      world->InsertFirstChild(from->DeepClone(world->GetDocument()));
    } else if (name == "default") {
      XMLElement* defaults = Append(section("default"), "default");
      Set(defaults, "class", main_class);
      CopyChildren(*from, defaults);
    } else if (name == "worldbody") {
      XMLElement* body = Append(section("worldbody"), "body");
      Set(body, "name", kRobotBody);
      SetPose(body, scenario.X_WB);
      if (robot.FirstChildElement("default") != nullptr) Set(body, "childclass", main_class);
      for (const XMLElement* child = from->FirstChildElement("body"); child != nullptr;
           child = child->NextSiblingElement("body")) {
        body->InsertEndChild(child->DeepClone(world->GetDocument()));
      }
    } else if (name == "asset" || name == "contact" || name == "equality" || name == "tendon" ||
               name == "actuator" || name == "sensor") {
      XMLElement* to = section(name.c_str());
      XMLElement* last_before = to->LastChildElement();
      CopyChildren(*from, to);
      XMLElement* child =
          last_before != nullptr ? last_before->NextSiblingElement() : to->FirstChildElement();
      for (; child != nullptr; child = child->NextSiblingElement()) {
        if (robot.FirstChildElement("default") != nullptr && TakesClass(name, child->Name()) &&
            child->Attribute("class") == nullptr) {
          Set(child, "class", main_class);
        }
      }
    }  // There is nothing else, CheckArmFile sees to it.
  }
}

// The scene ------------------------------------------------------------------------------------

void AddSettings(const scenarios::Scenario& scenario, XMLElement* world) {
  Append(world, "option", {{"timestep", "0.001"}, {"integrator", "Euler"}});
  // Room for a robot that lies deep in an obstacle; a simulation makes more where it needs it.
  Append(world, "size", {{"nconmax", "50"}, {"njmax", "250"}});
  Append(world, "statistic", {{"center", ToText(scenario.X_WB.translation())}, {"extent", "3"}});
  XMLElement* visual = Append(world, "visual");
  Append(visual, "global", {{"offwidth", "1920"}, {"offheight", "1080"}});
  Append(visual, "headlight",
         {{"ambient", "0.35 0.35 0.35"},
          {"diffuse", "0.35 0.35 0.35"},
          {"specular", "0.05 0.05 0.05"}});
  Append(visual, "map", {{"znear", "0.01"}, {"zfar", "20"}});
  Append(visual, "quality", {{"shadowsize", "2048"}});
}

void AddMaterial(XMLElement* asset, const char* name, const char* rgba) {
  Append(asset, "material",
         {{"name", name}, {"rgba", rgba}, {"specular", "0.15"}, {"shininess", "0.3"}});
}

constexpr const char* kFloorMaterial = "world/floor";
constexpr const char* kBoxMaterial = "world/box";
constexpr const char* kObstacleMaterial = "world/obstacle";

void AddAssets(XMLElement* world) {
  XMLElement* asset = Append(world, "asset");
  Append(asset, "texture",
         {{"name", "world/sky"},
          {"type", "skybox"},
          {"builtin", "gradient"},
          {"rgb1", "0.93 0.95 0.97"},
          {"rgb2", "0.62 0.70 0.78"},
          {"width", "256"},
          {"height", "256"}});
  Append(asset, "texture",
         {{"name", kFloorMaterial},
          {"type", "2d"},
          {"builtin", "checker"},
          {"rgb1", "0.72 0.74 0.76"},
          {"rgb2", "0.66 0.68 0.70"},
          {"width", "256"},
          {"height", "256"}});
  Append(asset, "material",
         {{"name", kFloorMaterial},
          {"texture", kFloorMaterial},
          {"texuniform", "true"},
          {"texrepeat", "1 1"},  // squares of one metre
          {"specular", "0.1"}});
  AddMaterial(asset, kBoxMaterial, "0.60 0.49 0.38 1");
  AddMaterial(asset, kObstacleMaterial, "0.85 0.42 0.12 1");
}

void AddFloorAndLights(const scenarios::Scenario& scenario, XMLElement* worldbody) {
  Append(worldbody, "geom",
         {{"name", kFloorGeom},
          {"type", "plane"},
          {"size", "0 0 1"},
          {"pos", ToText(Eigen::Vector3d(0, 0, scenario.floor_m))},
          {"material", kFloorMaterial}});
  Append(
      worldbody, "light",
      {{"directional", "true"},
       {"pos", ToText(Eigen::Vector3d(scenario.X_WB.translation() + Eigen::Vector3d(-1, -1.5, 4)))},
       {"dir", "0.25 0.35 -1"},
       {"diffuse", "0.55 0.55 0.55"},
       {"specular", "0.2 0.2 0.2"},
       {"castshadow", "true"}});
}

void AddCamera(const char* name, const Eigen::Vector3d& p_WEye, const Eigen::Vector3d& p_WTarget,
               const Eigen::Vector3d& up, XMLElement* worldbody) {
  const Eigen::Vector3d back = (p_WEye - p_WTarget).normalized();  // a camera looks along -z
  const Eigen::Vector3d right = up.cross(back).normalized();
  Eigen::Matrix<double, 6, 1> axes;
  axes << right, back.cross(right);
  Append(worldbody, "camera",
         {{"name", name}, {"pos", ToText(p_WEye)}, {"xyaxes", ToText(axes)}, {"fovy", "45"}});
}

// Both look at the space before the robot, `overview` over its shoulder: the robot does not hide
// what comes across its front, and what comes does not hide the robot.
void AddCameras(const scenarios::Scenario& scenario, XMLElement* worldbody) {
  const Pose& X_WB = scenario.X_WB;
  const Eigen::Vector3d target = X_WB * Eigen::Vector3d(0.35, 0, 0.2);
  AddCamera(kOverviewCamera, X_WB * Eigen::Vector3d(-1.55, -1.75, 1.6), target,
            X_WB.Rotate(Eigen::Vector3d::UnitZ()), worldbody);
  AddCamera(kTopCamera, X_WB * Eigen::Vector3d(0.35, 0, 3.6), target,
            X_WB.Rotate(Eigen::Vector3d::UnitX()), worldbody);
}

// Dark and light of a print without gloss. MuJoCo takes pictures from files alone, and a world's
// text refers to none; squares are also free of the blur that a texture is drawn with.
constexpr const char* kPaperMaterial = "world/paper";
constexpr const char* kInkMaterial = "world/ink";

// MuJoCo moves a mesh's vertices to where its centre of mass is, and its geoms as far back.
void AddMesh(const std::string& obstacle, const Shape& shape, XMLElement* asset) {
  const ConvexMesh* const mesh = std::get_if<ConvexMesh>(&shape);
  if (mesh == nullptr) return;
  std::string vertices;
  for (const Eigen::Vector3d& vertex : mesh->hull->vertices()) {
    vertices += (vertices.empty() ? "" : "  ") + ToText(vertex);
  }
  Append(asset, "mesh", {{"name", MeshName(obstacle)}, {"vertex", vertices}});
}

void AddMeshes(const scenarios::Scenario& scenario, XMLElement* asset) {
  for (const auto& fixed : scenario.static_obstacles) AddMesh(fixed.name, fixed.shape, asset);
  for (const auto& moving : scenario.moving_obstacles) AddMesh(moving.name, moving.shape, asset);
}

void AddTagMaterials(const scenarios::Scenario& scenario, XMLElement* asset) {
  const auto bears = [](const auto& box) { return !box.tags.empty(); };
  const auto& fixed = scenario.static_obstacles;
  const auto& moving = scenario.moving_obstacles;
  if (std::none_of(fixed.begin(), fixed.end(), bears) &&
      std::none_of(moving.begin(), moving.end(), bears)) {
    return;
  }
  for (const auto& [name, rgba] : {std::pair(kPaperMaterial, "0.92 0.92 0.92 1"),
                                   std::pair(kInkMaterial, "0.06 0.06 0.06 1")}) {
    Append(asset, "material", {{"name", name}, {"rgba", rgba}, {"specular", "0"}});
  }
}

// A rectangle in a tag's frame, edges [m], whose outer side is `behind_m` behind the tag's plane.
void AddPrint(const Pose& X_OT, const Eigen::Vector2d& center_m, const Eigen::Vector2d& edges_m,
              double behind_m, const char* material, XMLElement* body) {
  constexpr double kThick_m = 5e-4;
  XMLElement* geom = Append(body, "geom", {{"type", "box"}});
  Set(geom, "size", ToText(Eigen::Vector3d(edges_m.x() / 2, edges_m.y() / 2, kThick_m / 2)));
  const Eigen::Vector3d p_TG(center_m.x(), center_m.y(), kThick_m / 2 + behind_m);
  SetPose(geom, X_OT * Pose::Translation(p_TG));
  Set(geom, "material", material);
  Set(geom, "contype", "0");
  Set(geom, "conaffinity", "0");
  Set(geom, "group", "2");
}

void AddTag(const scenarios::Tag& tag, const Eigen::Vector3d& box_size_m, XMLElement* body) {
  constexpr int n = scenarios::kTagModules;
  const Pose X_OT = scenarios::TagPose(box_size_m, tag.face);
  const double print_m = scenarios::kTagPrint * tag.size_m, module_m = print_m / n;
  AddPrint(X_OT, {0, 0}, {print_m, print_m}, scenarios::kTagPaper_m / 2, kPaperMaterial, body);
  // The white rim is as high as the ink: from aside, the black square would else show a side, and
  // its edges be seen where they are not.
  for (const double side : {-1.0, 1.0}) {
    const double rim_m = side * (n - 1) / 2.0 * module_m;
    AddPrint(X_OT, {rim_m, 0}, {module_m, print_m}, 0, kPaperMaterial, body);
    AddPrint(X_OT, {0, rim_m}, {print_m - 2 * module_m, module_m}, 0, kPaperMaterial, body);
  }
  const auto black = scenarios::BlackModules(tag.id);
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {  // runs of black
      const auto is_black = [&](int at) {
        const int module = n * y + at;
        return at < n && black[static_cast<std::size_t>(module)];
      };
      int end = x;
      while (is_black(end)) ++end;
      if (end == x) continue;
      const Eigen::Vector2d center((x + end - n) / 2.0, y + 0.5 - n / 2.0);
      AddPrint(X_OT, module_m * center, {module_m * (end - x), module_m}, 0, kInkMaterial, body);
      x = end;
    }
  }
}

void AddTags(const std::vector<scenarios::Tag>& tags, const Shape& shape, XMLElement* body) {
  const Box* const box = std::get_if<Box>(&shape);
  for (const scenarios::Tag& tag : tags) AddTag(tag, box->size_m, body);
}

void AddStaticObstacle(const scenarios::StaticObstacle& obstacle, XMLElement* worldbody) {
  XMLElement* body = Append(worldbody, "body", {{"name", obstacle.name}});
  SetPose(body, obstacle.X_WO);
  XMLElement* geom = Append(body, "geom", {{"name", obstacle.name}});
  SetShape(geom, obstacle.shape, obstacle.name);
  Set(geom, "material", kBoxMaterial);
  AddTags(obstacle.tags, obstacle.shape, body);
}

// X_OA of the appearance in the obstacle's frame: at its foot, looking where it goes.
Pose AppearancePose(const scenarios::MovingObstacle& obstacle) {
  const Pose X_WO = PoseAt(obstacle, EpisodeTime(0));
  const Eigen::Vector3d ahead_O =
      X_WO.RotateInverse(scenarios::DirectionAt(obstacle.motion, EpisodeTime(0)));
  const bool level = ahead_O.head<2>().norm() > 1e-6 * ahead_O.norm();
  const double yaw = level ? std::atan2(ahead_O.y(), ahead_O.x()) : 0.0;
  return Pose::FromRollPitchYaw({0, 0, yaw}, {0, 0, -HalfExtents(obstacle.shape).z()});
}

void AddPicture(const scenarios::MovingObstacle& obstacle, const std::string& path,
                ModelStore* store, XMLElement* body) {
  XMLElement* frame = Append(body, "body");
  SetPose(frame, AppearancePose(obstacle));
  for (const PictureGeom& picture : PictureOf(path, store)) {
    XMLElement* geom =
        Append(frame, "geom", {{"type", picture.type}, {"size", ToText(picture.size)}});
    SetPose(geom, picture.X_AG);
    Set(geom, "rgba", ToText(picture.rgba));
    Set(geom, "contype", "0");
    Set(geom, "conaffinity", "0");
    Set(geom, "group", "2");
  }
}

void AddMovingObstacle(const scenarios::Scenario& scenario, std::size_t index,
                       const ModelFolders& models, ModelStore* store, XMLElement* worldbody) {
  const scenarios::MovingObstacle& obstacle = scenario.moving_obstacles[index];
  XMLElement* body = Append(worldbody, "body", {{"name", obstacle.name}, {"mocap", "true"}});
  SetPose(body, PoseAt(obstacle, EpisodeTime(0)));
  XMLElement* geom = Append(body, "geom", {{"name", obstacle.name}});
  SetShape(geom, obstacle.shape, obstacle.name);
  if (obstacle.appearance.empty()) {
    Set(geom, "material", kObstacleMaterial);
    AddTags(obstacle.tags, obstacle.shape, body);
    return;
  }
  Set(geom, "group", "4");
  Set(geom, "rgba", "0.85 0.42 0.12 0.25");
  const std::string file = obstacle.appearance + "/" + obstacle.appearance + ".xml";
  const auto folder = models.Find(obstacle.appearance);
  const std::string path = folder.value_or("") + "/" + obstacle.appearance + ".xml";
  if (!folder || !std::filesystem::is_regular_file(path)) {
    const std::string key = "moving_obstacles[" + std::to_string(index) + "].appearance";
    throw scenarios::WrongValue(scenario, key,
                                "there is no " + file + " in " + Joined(models.folders()));
  }
  AddPicture(obstacle, path, store, body);
}

// Names of bodies and geoms at or below `element`, as far as they have one.
void CollectNames(const XMLElement* element, std::set<std::string>* names) {
  for (; element != nullptr; element = element->NextSiblingElement()) {
    const std::string kind = element->Name();
    const char* const name = element->Attribute("name");
    if (name != nullptr && (kind == "body" || kind == "geom")) names->insert(name);
    CollectNames(element->FirstChildElement(), names);
  }
}

// MuJoCo knows one body and one geom of a name.
void RefuseNamesOfTheRobot(const scenarios::Scenario& scenario, const XMLElement* worldbody) {
  std::set<std::string> taken;
  CollectNames(worldbody->FirstChildElement(), &taken);
  const auto check = [&](const std::string& path, const std::string& name) {
    if (taken.count(name) == 0) return;
    throw scenarios::WrongValue(
        scenario, path + ".name",
        "'" + name + "' is the name of a part of the robot '" + scenario.robot + "'");
  };
  for (const auto& fixed : scenario.static_obstacles) check(fixed.path, fixed.name);
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    check("moving_obstacles[" + std::to_string(i) + "]", scenario.moving_obstacles[i].name);
  }
}

}  // namespace

std::string BuildWorldXml(const scenarios::Scenario& scenario,
                          const std::vector<std::string>& mount_links, const ModelFolders& models,
                          ModelStore* store) {
  XMLDocument document;
  XMLElement* world = document.NewElement("mujoco");
  document.InsertEndChild(world);
  Set(world, "model", scenario.name);
  AddSettings(scenario, world);
  AddAssets(world);
  AddTagMaterials(scenario, world->FirstChildElement("asset"));
  AddMeshes(scenario, world->FirstChildElement("asset"));
  XMLElement* worldbody = Append(world, "worldbody");
  AddFloorAndLights(scenario, worldbody);
  AddCameras(scenario, worldbody);
  if (!scenario.robot.empty()) {
    MergeRobot(scenario, RobotMjcf(scenario, models), world);
    RefuseNamesOfTheRobot(scenario, worldbody);
  }
  for (const auto& fixed : scenario.static_obstacles) AddStaticObstacle(fixed, worldbody);
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    AddMovingObstacle(scenario, i, models, store, worldbody);
  }
  if (!mount_links.empty()) {
    // The floor is a geom of the world itself, the only one that is.
    const std::string stands_on = scenario.mount.empty() ? "world" : scenario.mount;
    XMLElement* contact = world->FirstChildElement("contact");
    if (contact == nullptr) contact = Append(world, "contact");
    for (const std::string& link : mount_links) {
      Append(contact, "exclude", {{"body1", link}, {"body2", stands_on}});
    }
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::string WithoutPictures(std::string world_xml) {
  const std::size_t masses_are_given = world_xml.find("inertiafromgeom=\"false\"");
  if (masses_are_given != std::string::npos) {
    world_xml.insert(masses_are_given, "discardvisual=\"true\" ");
  }
  return world_xml;
}

}  // namespace sidestep::sim
