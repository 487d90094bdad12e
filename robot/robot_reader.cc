#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/model_name.h"
#include "sidestep/core/yaml_reader.h"
#include "sidestep/robot/limit_keys.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/robot/variant_names.h"

namespace sidestep::robot {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostJoints = 128;  // with those that are fixed

// A robot.yaml, or a variant, which says the spheres anew and, if it likes, which links can reach
// each other; everything else is as in the robot.yaml that it extends.
class RobotFile {
 public:
  explicit RobotFile(const std::string& path) : path_(path), robot_(YamlReader::FromFile(path)) {
    if (!Extends(robot_)) return;
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    path_ = (folder / robot_.GetString("extends")).string();
    variant_ = std::move(robot_);
    robot_ = YamlReader::FromFile(path_);
    if (Extends(robot_)) variant_->Fail("extends", "must be a whole robot, is a variant");
  }

  /// Of the whole robot.
  const std::string& path() const { return path_; }
  const YamlReader& robot() const { return robot_; }
  bool is_variant() const { return variant_.has_value(); }
  /// Where spheres are, and which of them are at the mount.
  const YamlReader& of_spheres() const {
    robot_.Has("spheres");  // known, though a variant has others
    return variant_ ? *variant_ : robot_;
  }
  const YamlReader& of_self_collision() const {
    robot_.Has("self_collision");
    return variant_ && variant_->Has("self_collision") ? *variant_ : robot_;
  }
  void CheckNoUnknownKeys() const {
    if (variant_) variant_->CheckNoUnknownKeys();
    robot_.CheckNoUnknownKeys();
  }

 private:
  static bool Extends(
      const YamlReader& file) {  // is no key of a whole robot, so it is not asked for
    const std::vector<std::string> keys = file.Keys();
    return std::find(keys.begin(), keys.end(), "extends") != keys.end();
  }

  std::string path_;
  YamlReader robot_;
  std::optional<YamlReader> variant_;
};

// Links by name, in the order of the joints that carry them. A number stands for a joint of the
// list, -1 for the base.
class LinkNames {
 public:
  explicit LinkNames(std::string base) : base_(std::move(base)) {}

  void Add(const std::string& link) { names_.push_back(link); }
  std::optional<int> Find(const std::string& name) const {
    if (name == base_) return -1;
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) return static_cast<int>(found - names_.begin());
    return std::nullopt;
  }
  // The link that `text` names, or whose joint has that number; else it is told under `key`.
  int Resolve(const YamlReader& map, const std::string& key, const std::string& text) const {
    if (const std::optional<int> link = Find(text)) return *link;
    for (int number = -1; number < static_cast<int>(names_.size()); ++number) {
      if (text == std::to_string(number)) return number;
    }
    map.Fail(key, "must be a link (" + base_ + ", " + Joined(names_) +
                      ") or a joint's number, -1 to " +
                      std::to_string(static_cast<int>(names_.size()) - 1) + ", is '" + text + "'");
  }
  int Get(const YamlReader& map, const std::string& key) const {
    return Resolve(map, key, map.GetString(key));
  }

 private:
  std::string base_;
  std::vector<std::string> names_;
};

DhRow ReadDhRow(const YamlReader& map) {
  const DhRow row{map.GetDouble("a_m"), map.GetDouble("alpha_rad"), map.GetDouble("d_m"),
                  map.GetDouble("theta_rad")};
  map.CheckNoUnknownKeys();
  return row;
}

JointLimits ReadLimits(const YamlReader& map, const LimitKeys& keys) {
  const auto positive_or_infinite = [&map](const std::string& key) {
    return map.Has(key) ? map.GetPositive(key) : kInfinity;
  };
  JointLimits limits;
  limits.q_min = map.Has(keys.q_min) ? map.GetDouble(keys.q_min) : -kInfinity;
  limits.q_max = map.Has(keys.q_max) ? map.GetDouble(keys.q_max) : kInfinity;
  limits.v_max = positive_or_infinite(keys.v_max);
  limits.a_max = positive_or_infinite(keys.a_max);
  limits.jerk_max = positive_or_infinite(keys.jerk_max);
  limits.torque_max = positive_or_infinite(keys.torque_max);
  limits.torque_rate_max = positive_or_infinite(keys.torque_rate_max);
  if (!(limits.q_min < limits.q_max)) {
    map.Fail(keys.q_min,
             std::string("must be < ") + keys.q_max + ", is " + map.GetString(keys.q_min));
  }
  map.CheckNoUnknownKeys();
  return limits;
}

Eigen::Vector3d ReadAxis(const YamlReader& map) {
  if (!map.Has("axis")) return Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d axis = map.GetVector3("axis");
  const double norm = axis.stableNorm();
  if (!(norm > 1e-6)) map.Fail("axis", "must not be zero");
  return axis / norm;
}

// Reads the list of joints one by one; parents come before children.
class JointReader {
 public:
  explicit JointReader(const std::string& base) : links_(base) {}

  void Read(const YamlReader& map) {
    Joint joint;
    joint.name = map.GetString("name");
    for (const Joint& other : joints_) {
      if (other.name == joint.name) map.Fail("name", "is the name of an earlier joint too");
    }
    joint.link = map.Has("link") ? map.GetString("link") : joint.name;
    if (links_.Find(joint.link)) {
      map.Fail(map.Has("link") ? "link" : "name",
               "'" + joint.link + "' is the name of the base or of an earlier link too");
    }
    const std::string kind =
        map.Has("kind") ? map.GetChoice("kind", {"revolute", "prismatic", "fixed"}) : "revolute";
    joint.kind = kind == "fixed"       ? JointKind::kFixed
                 : kind == "prismatic" ? JointKind::kPrismatic
                                       : JointKind::kRevolute;
    joint.parent = static_cast<int>(joints_.size()) - 1;
    if (map.Has("parent")) {
      const std::optional<int> parent = links_.Find(map.GetString("parent"));
      if (!parent) {
        map.Fail("parent", "must be the base or the link of an earlier joint, is '" +
                               map.GetString("parent") + "'");
      }
      joint.parent = *parent;
    }
    if (map.Has("origin")) joint.X_PJ = map.GetPose("origin");
    if (joint.kind != JointKind::kFixed) ReadMotion(map, joint);
    map.CheckNoUnknownKeys();
    links_.Add(joint.link);
    joints_.push_back(joint);
  }

  const std::vector<Joint>& joints() const { return joints_; }
  const std::vector<int>& moving() const { return moving_; }
  const std::vector<JointLimits>& limits() const { return limits_; }
  const LinkNames& links() const { return links_; }

 private:
  void ReadMotion(const YamlReader& map, Joint& joint) {
    if (map.Has("dh")) {
      if (map.Has("axis")) map.Fail("axis", "is not wanted beside dh, whose axis is z");
      joint.dh = ReadDhRow(map.GetMap("dh"));
    } else {
      joint.axis_J = ReadAxis(map);
      if (!map.Has("axis") && !map.Has("origin")) {
        map.Fail("dh", "must be given, or else origin or axis");
      }
    }
    if (map.Has("mimic")) {
      ReadMimic(map.GetMap("mimic"), joint);
      return;
    }
    if (!map.Has("limits")) {
      map.Fail("limits", "must be given for a joint that moves ({} if it has none)");
    }
    joint.coordinate = static_cast<int>(moving_.size());
    moving_.push_back(static_cast<int>(joints_.size()));
    limits_.push_back(ReadLimits(map.GetMap("limits"), LimitKeysOf(joint.kind)));
  }

  void ReadMimic(const YamlReader& map, Joint& joint) {
    const std::string name = map.GetString("joint");
    for (const Joint& other : joints_) {
      if (other.name == name && other.coordinate >= 0) {
        joint.coordinate = other.coordinate;
        joint.multiplier = other.multiplier;
        joint.offset = other.offset;
      }
    }
    if (joint.coordinate < 0) {
      map.Fail("joint", "must be an earlier joint that moves, is '" + name + "'");
    }
    const double multiplier = map.Has("multiplier") ? map.GetDouble("multiplier") : 1;
    if (multiplier == 0) map.Fail("multiplier", "must not be 0: a joint that stays is fixed");
    const char* const offset = joint.kind == JointKind::kPrismatic ? "offset_m" : "offset_rad";
    joint.multiplier *= multiplier;
    joint.offset = multiplier * joint.offset + (map.Has(offset) ? map.GetDouble(offset) : 0);
    map.CheckNoUnknownKeys();
  }

  std::vector<Joint> joints_;
  std::vector<int> moving_;
  std::vector<JointLimits> limits_;
  LinkNames links_;
};

ToolLimits ReadToolLimits(const YamlReader& map) {
  ToolLimits limits;
  if (map.Has("a_max_m_s2")) limits.a_max = map.GetPositive("a_max_m_s2");
  if (map.Has("a_reflex_m_s2")) limits.a_reflex = map.GetPositive("a_reflex_m_s2");
  map.CheckNoUnknownKeys();
  return limits;
}

CollisionSphere ReadSphere(const YamlReader& map, const LinkNames& links) {
  CollisionSphere sphere;
  sphere.link = links.Get(map, "link");
  sphere.p_LS = map.GetVector3("center_m");
  sphere.radius_m = map.GetPositive("radius_m");
  map.CheckNoUnknownKeys();
  return sphere;
}

CollisionCapsule ReadCapsule(const YamlReader& map, const LinkNames& links) {
  CollisionCapsule capsule;
  capsule.link = links.Get(map, "link");
  capsule.p_LA = map.GetVector3("from_m");
  capsule.p_LB = map.GetVector3("to_m");
  capsule.radius_m = map.GetPositive("radius_m");
  map.CheckNoUnknownKeys();
  return capsule;
}

std::map<std::string, Eigen::VectorXd> ReadConfigurations(
    const YamlReader& map, const std::vector<std::string>& joint_names,
    const std::vector<JointLimits>& limits) {
  std::map<std::string, Eigen::VectorXd> configurations;
  for (const std::string& name : map.Keys()) {
    const Eigen::VectorXd q = map.GetVector(name, static_cast<int>(limits.size()));
    for (std::size_t j = 0; j < limits.size(); ++j) {
      const double value = q(static_cast<Eigen::Index>(j));
      if (value < limits[j].q_min || value > limits[j].q_max) {
        map.Fail(name, "is outside the limits of " + joint_names[j]);
      }
    }
    configurations[name] = q;
  }
  return configurations;
}

std::vector<int> ReadSphereIndices(const YamlReader& map, int num_spheres) {
  std::vector<int> indices;
  for (const double value : map.GetDoubles("spheres")) {
    if (value != std::floor(value) || value < 0 || value >= num_spheres) {
      map.Fail("spheres", "must be whole numbers from 0 to " + std::to_string(num_spheres - 1));
    }
    indices.push_back(static_cast<int>(value));
  }
  std::sort(indices.begin(), indices.end());
  if (std::adjacent_find(indices.begin(), indices.end()) != indices.end()) {
    map.Fail("spheres", "names a sphere twice");
  }
  return indices;
}

std::vector<LinkPair> ReadSelfCollision(const YamlReader& file, const LinkNames& names,
                                        const std::vector<CollisionSphere>& spheres) {
  const std::string key = "self_collision";
  std::vector<LinkPair> pairs;
  for (const YamlReader& entry : file.GetMaps(key)) {
    const std::vector<std::string> two = entry.GetStrings("links");
    if (two.size() != 2) {
      entry.Fail("links", "must be two links, are " + std::to_string(two.size()));
    }
    const LinkPair pair{names.Resolve(entry, "links", two[0]),
                        names.Resolve(entry, "links", two[1])};
    for (const int link : {pair.first, pair.second}) {
      const auto is_there = [link](const CollisionSphere& s) { return s.link == link; };
      if (std::none_of(spheres.begin(), spheres.end(), is_there)) {
        entry.Fail("links", "must be two links with spheres");
      }
    }
    if (pair.first >= pair.second) entry.Fail("links", "must name the lower link first");
    for (const LinkPair& other : pairs) {
      if (other.first == pair.first && other.second == pair.second) {
        entry.Fail("links", "are named twice");
      }
    }
    entry.CheckNoUnknownKeys();
    pairs.push_back(pair);
  }
  return pairs;
}

Eigen::VectorXd ReadGains(const YamlReader& map, const std::string& key, int num_joints) {
  const Eigen::VectorXd gains = map.GetVector(key, num_joints);
  if (!(gains.minCoeff() > 0)) map.Fail(key, "must all be > 0");
  return gains;
}

}  // namespace

std::vector<std::string> RobotModel::ListNames(const ModelFolders& models) {
  return models.NamesWith("robot.yaml");
}

RobotModel RobotModel::Load(const ModelFolders& models, const std::string& name, const Pose& X_WB) {
  const std::vector<std::string> names = ListNames(models);
  const std::string folder = ModelFolder(name);
  if (std::find(names.begin(), names.end(), folder) == names.end()) {
    throw InputError(Joined(models.folders()), "holds no robot '" + folder + "' (known: " +
                                                   (names.empty() ? "none" : Joined(names)) + ")");
  }
  return FromFolder(models.Find(folder).value(), ModelVariant(name), X_WB);
}

RobotModel RobotModel::FromFolder(const std::string& folder, const std::string& variant,
                                  const Pose& X_WB) {
  const std::string path = folder + "/" + DescriptionFile(variant);
  const std::string name = std::filesystem::path(folder).filename().string();
  if (std::error_code error; !variant.empty() && !std::filesystem::exists(path, error)) {
    const std::vector<std::string> variants = VariantNames(folder);
    throw InputError(folder, "holds no variant '" + name + ":" + variant + "' (known: " +
                                 (variants.empty() ? "none" : Joined(variants)) + ")");
  }
  RobotModel model = FromFile(path, X_WB);
  if (model.name() != name) {
    throw InputError(path, "name: must be the folder's, is '" + model.name() + "'");
  }
  return model;
}

RobotModel RobotModel::FromFile(const std::string& path, const Pose& X_WB) {
  const RobotFile whole(path);
  const YamlReader& file = whole.robot();
  RobotModel model;
  model.X_WB_ = X_WB;
  model.file_ = whole.path();
  model.name_ = file.GetString("name");
  model.base_ = file.Has("base") ? file.GetString("base") : "base";

  JointReader reader(model.base_);
  const std::vector<YamlReader> joints = file.GetMaps("joints");
  if (joints.size() > kMostJoints) {
    file.Fail("joints", "must be at most " + std::to_string(kMostJoints) + " in all, are " +
                            std::to_string(joints.size()));
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const YamlReader& joint = joints[i];
    reader.Read(joint);
    const std::string key = "joints[" + std::to_string(i) + "]";
    for (const char* const part : {"name", "link", "dh", "origin"}) {
      model.lines_[key + "." + part] = joint.Line(part);
    }
    if (!joint.Has("limits")) continue;
    const YamlReader limits = joint.GetMap("limits");
    const LimitKeys keys = LimitKeysOf(reader.joints().back().kind);
    for (const char* const limit : {keys.q_min, keys.q_max, keys.v_max, keys.torque_max}) {
      model.lines_[key + ".limits." + limit] = limits.Line(limit);
    }
  }
  model.joints_ = reader.joints();
  model.moving_joints_ = reader.moving();
  model.limits_ = reader.limits();
  for (const int joint : model.moving_joints_) {
    model.joint_names_.push_back(model.joints_[static_cast<std::size_t>(joint)].name);
  }
  const int n = model.num_joints();
  if (n < 1 || n > kMaxJoints) {
    file.Fail("joints",
              "must be 1 to " + std::to_string(kMaxJoints) + " joints, are " + std::to_string(n));
  }
  model.kinematics_ = Kinematics(model.joints_);
  if (model.kinematics_.rows().size() > kMaxRows) {
    file.Fail("joints", "must be at most " + std::to_string(kMaxRows) +
                            " that move, with those that mimic others");
  }

  const LinkNames& links = reader.links();
  for (const YamlReader& sphere : whole.of_spheres().GetMaps("spheres")) {
    model.spheres_.push_back(ReadSphere(sphere, links));
  }
  if (model.spheres_.empty()) whole.of_spheres().Fail("spheres", "must not be empty");
  model.radii_m_.resize(model.num_spheres());
  for (int s = 0; s < model.num_spheres(); ++s) {
    model.radii_m_(s) = model.spheres_[static_cast<std::size_t>(s)].radius_m;
  }

  model.tool_link_ = static_cast<int>(model.joints_.size()) - 1;
  if (file.Has("tool_frame")) {
    const YamlReader frame = file.GetMap("tool_frame");
    model.tool_link_ = links.Get(frame, "link");
    if (frame.Has("position_m") || frame.Has("rpy_rad")) {
      const auto vector = [&frame](const char* key) {
        return frame.Has(key) ? frame.GetVector3(key) : Eigen::Vector3d(0, 0, 0);
      };
      model.X_LTool_ = Pose::FromRollPitchYaw(vector("rpy_rad"), vector("position_m"));
    }
    frame.CheckNoUnknownKeys();
  }
  if (file.Has("tool")) model.tool_limits_ = ReadToolLimits(file.GetMap("tool"));
  if (file.Has("capsules")) {
    for (const YamlReader& capsule : file.GetMaps("capsules")) {
      model.capsules_.push_back(ReadCapsule(capsule, links));
    }
    if (model.capsules_.size() > kMaxCapsules) {
      file.Fail("capsules", "must be at most " + std::to_string(kMaxCapsules));
    }
  }

  model.configurations_ =
      ReadConfigurations(file.GetMap("configurations"), model.joint_names_, model.limits_);

  const YamlReader mount = file.GetMap("mount");
  model.mount_links_ = mount.GetStrings("links");
  model.lines_["mount.links"] = mount.Line("links");
  if (whole.is_variant()) {  // the spheres are other ones, the bodies of the MJCF the same
    mount.Has("spheres");
    const YamlReader spheres = whole.of_spheres().GetMap("mount");
    model.mount_spheres_ = ReadSphereIndices(spheres, model.num_spheres());
    spheres.CheckNoUnknownKeys();
  } else {
    model.mount_spheres_ = ReadSphereIndices(mount, model.num_spheres());
  }
  mount.CheckNoUnknownKeys();

  if (whole.of_self_collision().Has("self_collision")) {
    model.self_collision_ = ReadSelfCollision(whole.of_self_collision(), links, model.spheres_);
  }

  const YamlReader control = file.GetMap("control");
  model.stiffness_ = ReadGains(control, "stiffness_n_m_rad", n);
  model.damping_ = ReadGains(control, "damping_n_m_s_rad", n);
  control.CheckNoUnknownKeys();

  whole.CheckNoUnknownKeys();
  return model;
}

}  // namespace sidestep::robot
