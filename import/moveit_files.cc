#include "sidestep/import/moveit_files.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/yaml_reader.h"

namespace sidestep::imports {
namespace {

using Eigen::Vector3d;

constexpr double kFarthest_m = 1e6;

// [x, y, z] or {x: , y: , z: }.
Vector3d ReadVector(const YamlReader& map, const std::string& key) {
  if (!map.IsMap(key)) return map.GetVector3(key);
  const YamlReader xyz = map.GetMap(key);
  return {xyz.GetDouble("x"), xyz.GetDouble("y"), xyz.GetDouble("z")};
}

// The same with w at the end.
Eigen::Quaterniond ReadRotation(const YamlReader& map, const std::string& key) {
  Eigen::Vector4d xyzw;
  if (map.IsMap(key)) {
    const YamlReader parts = map.GetMap(key);
    // Not by Eigen's <<, which ends the program where one of them throws in between.
    const char* const keys[] = {"x", "y", "z", "w"};
    for (int i = 0; i < 4; ++i) xyzw(i) = parts.GetDouble(keys[i]);
  } else {
    xyzw = map.GetVector(key, 4);
  }
  if (std::abs(xyzw.norm() - 1) > 0.01) {
    map.Fail(key, "must be a quaternion x, y, z, w of length 1, has " + ShortestText(xyzw.norm()));
  }
  return Eigen::Quaterniond(xyzw);
}

Pose ReadPose(const YamlReader& pose) {
  const Vector3d position = pose.Has("position") ? ReadVector(pose, "position") : Vector3d(0, 0, 0);
  return {
      pose.Has("orientation") ? ReadRotation(pose, "orientation") : Eigen::Quaterniond::Identity(),
      position};
}

// "box", "cylinder", ...; messages have numbers instead (shape_msgs/SolidPrimitive).
std::string KindOf(const YamlReader& primitive) {
  std::string kind = primitive.GetString("type");
  const char* const numbered[] = {"box", "sphere", "cylinder", "cone"};
  if (kind.size() == 1 && kind[0] >= '1' && kind[0] <= '4') return numbered[kind[0] - '1'];
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind;
}

std::vector<double> ReadSizes(const YamlReader& primitive, std::size_t count) {
  const std::vector<double> sizes = primitive.GetDoubles("dimensions");
  if (sizes.size() < count) {
    primitive.Fail("dimensions", "must have " + std::to_string(count) + " numbers, has " +
                                     std::to_string(sizes.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!(sizes[i] >= 1 / YamlReader::kLargestNumber)) {
      primitive.Fail("dimensions[" + std::to_string(i) + "]",
                     "must be > 0, is " + ShortestText(sizes[i]));
    }
  }
  return sizes;
}

// None for a kind that scenarios do not have.
std::optional<Shape> ReadPrimitive(const YamlReader& primitive) {
  const std::string kind = KindOf(primitive);
  if (kind == "box") {
    const std::vector<double> sizes = ReadSizes(primitive, 3);
    return Box{{sizes[0], sizes[1], sizes[2]}};
  }
  if (kind == "sphere") return Sphere{ReadSizes(primitive, 1)[0]};
  if (kind == "cylinder") {
    const std::vector<double> sizes = ReadSizes(primitive, 2);
    return Cylinder{sizes[1], sizes[0]};
  }
  return std::nullopt;
}

std::vector<Vector3d> ReadVertices(const YamlReader& mesh) {
  std::vector<Vector3d> vertices;
  if (mesh.IsListOfMaps("vertices")) {
    for (const YamlReader& vertex : mesh.GetMaps("vertices")) {
      vertices.emplace_back(vertex.GetDouble("x"), vertex.GetDouble("y"), vertex.GetDouble("z"));
    }
    return vertices;
  }
  for (const std::vector<double>& row : mesh.GetRows("vertices")) {
    if (row.size() != 3) {
      mesh.Fail("vertices[" + std::to_string(vertices.size()) + "]",
                "must have 3 numbers, has " + std::to_string(row.size()));
    }
    vertices.emplace_back(row[0], row[1], row[2]);
  }
  return vertices;
}

class SceneReader {
 public:
  explicit SceneReader(std::string file) : file_(std::move(file)) {}

  void ReadObject(const YamlReader& object) {
    const std::string id = object.GetString("id");
    const Pose X_WObject = object.IsMap("pose") ? ReadPose(object.GetMap("pose")) : Pose();
    ReadShapes(object, id, X_WObject, "primitives", "primitive_poses");
    ReadShapes(object, id, X_WObject, "meshes", "mesh_poses");
    if (object.Has("planes") && object.IsListOfMaps("planes")) {
      LeaveOut(object, "planes", id, "a plane: give the scenario a floor_m instead");
    }
  }

  ImportedScene Take() { return std::move(scene_); }

 private:
  void ReadShapes(const YamlReader& object, const std::string& id, const Pose& X_WObject,
                  const std::string& shapes_key, const std::string& poses_key) {
    if (!object.IsListOfMaps(shapes_key)) return;
    const std::vector<YamlReader> shapes = object.GetMaps(shapes_key);
    const std::vector<YamlReader> poses =
        object.IsListOfMaps(poses_key) ? object.GetMaps(poses_key) : std::vector<YamlReader>();
    if (!poses.empty() && poses.size() != shapes.size()) {
      object.Fail(poses_key, "must be as many as " + shapes_key + ", are " +
                                 std::to_string(poses.size()) + " of " +
                                 std::to_string(shapes.size()));
    }
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const Pose X_WO = poses.empty() ? X_WObject : X_WObject * ReadPose(poses[i]);
      if (shapes_key == "meshes") {
        AddMesh(object, shapes[i], id, X_WO);
      } else if (const auto shape = ReadPrimitive(shapes[i])) {
        Add(id, *shape, X_WO);
      } else {
        LeaveOut(shapes[i], "type", id, "a " + KindOf(shapes[i]) + " is no shape of scenarios");
      }
    }
  }

  void AddMesh(const YamlReader& object, const YamlReader& mesh, const std::string& id,
               const Pose& X_WO) {
    if (!mesh.Has("vertices")) {
      return LeaveOut(object, "meshes", id, "a mesh without inline vertices");
    }
    const std::vector<Vector3d> vertices = ReadVertices(mesh);
    try {
      Add(id, scenarios::MakeConvexMesh(vertices), X_WO);
      scene_.changed.push_back("'" + id + "': the convex hull of its mesh");
    } catch (const std::invalid_argument& fault) {
      LeaveOut(mesh, "vertices", id, std::string("vertices ") + fault.what());
    }
  }

  void Add(const std::string& id, const Shape& shape, const Pose& X_WO) {
    if (X_WO.translation().norm() > kFarthest_m) {
      scene_.left_out.push_back(file_ + ": '" + id + "': stands more than 1000 km away");
      return;
    }
    scene_.obstacles.push_back({FreeName(id, taken_), X_WO, shape});
  }

  void LeaveOut(const YamlReader& map, const std::string& key, const std::string& id,
                const std::string& why) {
    scene_.left_out.push_back(file_ + ":" + std::to_string(map.Line(key)) + ": '" + id +
                              "': " + why);
  }

  std::string file_;
  ImportedScene scene_;
  std::vector<std::string> taken_ = {"floor", "self", "world"};
};

bool HoldsData(const YamlReader& octomap) {
  if (!octomap.Has("data")) return false;
  return octomap.IsScalar("data") || !octomap.GetStrings("data").empty();
}

std::string PlaceOf(const std::string& file, const YamlReader& map, const std::string& key,
                    const std::string& path) {
  return file + ":" + std::to_string(map.Line(key)) + ": " + path;
}

std::optional<NamedJoints> ReadJointGoal(const std::string& file, const YamlReader& goal) {
  if (!goal.IsListOfMaps("joint_constraints")) return std::nullopt;
  NamedJoints joints;
  joints.place = PlaceOf(file, goal, "joint_constraints", "goal_constraints[0].joint_constraints");
  joints.line = goal.Line("joint_constraints");
  for (const YamlReader& one : goal.GetMaps("joint_constraints")) {
    joints.names.push_back(one.GetString("joint_name"));
    joints.positions.push_back(one.GetDouble("position"));
  }
  return joints;
}

// A position constraint is a region, whose first primitive's centre is meant.
std::optional<NamedTarget> ReadPoseGoal(const std::string& file, const YamlReader& goal) {
  const std::string positions = "position_constraints", orientations = "orientation_constraints";
  if (!goal.IsListOfMaps(positions)) return std::nullopt;
  if (!goal.IsListOfMaps(orientations)) {
    goal.Fail(positions, "need orientation_constraints beside them: a pose is whole");
  }
  const YamlReader position = std::move(goal.GetMaps(positions).front());
  const YamlReader orientation = std::move(goal.GetMaps(orientations).front());
  NamedTarget target;
  target.place = PlaceOf(file, goal, positions, "goal_constraints[0].position_constraints");
  target.line = goal.Line(positions);
  target.link = position.GetString("link_name");
  if (orientation.GetString("link_name") != target.link) {
    goal.Fail(orientations, "must be of the link of position_constraints, '" + target.link + "'");
  }
  const YamlReader region = position.GetMap("constraint_region");
  if (!region.IsListOfMaps("primitive_poses")) {
    region.Fail("primitive_poses", "must list where the region is");
  }
  const Pose X_WRegion = ReadPose(region.GetMaps("primitive_poses").front());
  const Eigen::Quaterniond R_WL = ReadRotation(orientation, "orientation");
  const Vector3d p_LPoint = position.Has("target_point_offset")
                                ? ReadVector(position, "target_point_offset")
                                : Vector3d(0, 0, 0);
  target.X_WL = Pose(R_WL, X_WRegion.translation() - R_WL * p_LPoint);
  return target;
}

}  // namespace

std::string FreeName(const std::string& name, std::vector<std::string>& taken) {
  std::string plain;
  for (const char c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    plain += is_plain && static_cast<unsigned char>(c) < 128 ? c : '_';
  }
  if (plain.empty()) plain = "thing";
  std::string free = plain;
  for (int n = 2; std::find(taken.begin(), taken.end(), free) != taken.end(); ++n) {
    free = plain + "_" + std::to_string(n);
  }
  taken.push_back(free);
  return free;
}

namespace {

ImportedScene ReadScene(const YamlReader& file, const std::string& path) {
  const YamlReader world = file.GetMap("world");
  SceneReader reader(path);
  if (world.Has("collision_objects")) {
    for (const YamlReader& object : world.GetMaps("collision_objects")) reader.ReadObject(object);
  }
  ImportedScene scene = reader.Take();
  if (world.IsMap("octomap")) {
    const YamlReader octomap = world.GetMap("octomap");
    if (octomap.IsMap("octomap") && HoldsData(octomap.GetMap("octomap"))) {
      scene.left_out.push_back(path + ":" + std::to_string(world.Line("octomap")) +
                               ": the octomap: its cells are no shapes");
    }
  }
  return scene;
}

ImportedRequest ReadRequest(const YamlReader& file, const std::string& path) {
  ImportedRequest request;
  if (file.IsMap("start_state") && file.GetMap("start_state").IsMap("joint_state")) {
    const YamlReader state = file.GetMap("start_state").GetMap("joint_state");
    NamedJoints joints;
    joints.place = PlaceOf(path, state, "name", "start_state.joint_state.name");
    joints.line = state.Line("name");
    joints.names = state.GetStrings("name");
    joints.positions = state.GetDoubles("position");
    if (joints.names.size() != joints.positions.size()) {
      state.Fail("position", "must be as many as name, are " +
                                 std::to_string(joints.positions.size()) + " of " +
                                 std::to_string(joints.names.size()));
    }
    if (!joints.names.empty()) request.start = std::move(joints);
  }
  if (!file.IsListOfMaps("goal_constraints")) {
    file.Fail("goal_constraints", "must list a goal");
  }
  const std::vector<YamlReader> goals = file.GetMaps("goal_constraints");
  request.goal = ReadJointGoal(path, goals.front());
  if (!request.goal) request.goal_pose = ReadPoseGoal(path, goals.front());
  if (!request.goal && !request.goal_pose) {
    file.Fail("goal_constraints[0]",
              "must have joint_constraints, or position_constraints and orientation_constraints");
  }
  for (std::size_t i = 1; i < goals.size(); ++i) {
    request.left_out.push_back(path + ":" + std::to_string(file.Line("goal_constraints")) +
                               ": goal_constraints[" + std::to_string(i) +
                               "]: a scenario has one goal, the first is taken");
  }
  return request;
}

}  // namespace

ImportedScene ReadMoveItScene(const std::string& path) {
  return ReadScene(YamlReader::FromFile(path), path);
}

ImportedScene ParseMoveItScene(const std::string& text, const std::string& name) {
  return ReadScene(YamlReader::FromText(text, name), name);
}

ImportedRequest ReadMoveItRequest(const std::string& path) {
  return ReadRequest(YamlReader::FromFile(path), path);
}

ImportedRequest ParseMoveItRequest(const std::string& text, const std::string& name) {
  return ReadRequest(YamlReader::FromText(text, name), name);
}

}  // namespace sidestep::imports
