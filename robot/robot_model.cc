#include "sidestep/robot/robot_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/yaml_reader.h"

namespace sidestep::robot {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

DhRow ReadDhRow(const YamlReader& map) {
  const DhRow row{map.GetDouble("a_m"), map.GetDouble("alpha_rad"), map.GetDouble("d_m"),
                  map.GetDouble("theta_rad")};
  map.CheckNoUnknownKeys();
  return row;
}

JointLimits ReadLimits(const YamlReader& map) {
  const auto positive_or_infinite = [&map](const std::string& key) {
    return map.Has(key) ? map.GetPositive(key) : kInfinity;
  };
  JointLimits limits;
  limits.q_min = map.Has("q_min_rad") ? map.GetDouble("q_min_rad") : -kInfinity;
  limits.q_max = map.Has("q_max_rad") ? map.GetDouble("q_max_rad") : kInfinity;
  limits.v_max = positive_or_infinite("v_max_rad_s");
  limits.a_max = positive_or_infinite("a_max_rad_s2");
  limits.jerk_max = positive_or_infinite("jerk_max_rad_s3");
  limits.torque_max = positive_or_infinite("torque_max_n_m");
  limits.torque_rate_max = positive_or_infinite("torque_rate_max_n_m_s");
  if (!(limits.q_min < limits.q_max)) {
    map.Fail("q_min_rad", "must be < q_max_rad, is " + map.GetString("q_min_rad"));
  }
  map.CheckNoUnknownKeys();
  return limits;
}

ToolLimits ReadToolLimits(const YamlReader& map) {
  ToolLimits limits;
  if (map.Has("a_max_m_s2")) limits.a_max = map.GetPositive("a_max_m_s2");
  if (map.Has("a_reflex_m_s2")) limits.a_reflex = map.GetPositive("a_reflex_m_s2");
  map.CheckNoUnknownKeys();
  return limits;
}

CollisionSphere ReadSphere(const YamlReader& map, int num_joints) {
  CollisionSphere sphere;
  sphere.link = map.GetInt("link");
  if (sphere.link < 0 || sphere.link >= num_joints) {
    map.Fail("link", "must be 0 to " + std::to_string(num_joints - 1) + ", is " +
                         std::to_string(sphere.link));
  }
  sphere.p_LS = map.GetVector3("center_m");
  sphere.radius_m = map.GetPositive("radius_m");
  map.CheckNoUnknownKeys();
  return sphere;
}

CollisionCapsule ReadCapsule(const YamlReader& map, int num_joints) {
  CollisionCapsule capsule;
  capsule.link = map.GetInt("link");
  if (capsule.link < -1 || capsule.link >= num_joints) {
    map.Fail("link", "must be -1 (the base) to " + std::to_string(num_joints - 1) + ", is " +
                         std::to_string(capsule.link));
  }
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

std::vector<LinkPair> ReadSelfCollision(const YamlReader& file,
                                        const std::vector<CollisionSphere>& spheres) {
  const std::string key = "self_collision";
  std::vector<LinkPair> pairs;
  for (const YamlReader& entry : file.GetMaps(key)) {
    const Eigen::VectorXd links = entry.GetVector("links", 2);
    for (const double link : links) {
      const auto is_there = [link](const CollisionSphere& s) { return s.link == link; };
      if (std::none_of(spheres.begin(), spheres.end(), is_there)) {
        entry.Fail("links", "must be two links with spheres");
      }
    }
    const LinkPair pair{static_cast<int>(links(0)), static_cast<int>(links(1))};
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

// Everything in world axes. Joint j (0-based) turns about z_W.col(j) through p_WJ.col(j); link i is
// the frame after DH row i.
struct RobotModel::Chain {
  template <int kColumns>
  using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kColumns>;

  Columns<kMaxJoints> z_W, p_WJ, p_WL;
  std::array<Eigen::Matrix3d, kMaxJoints> R_WL;
};

std::vector<std::string> RobotModel::ListNames(const std::string& models_dir) {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(models_dir, error)) {
    if (fs::exists(entry.path() / "robot.yaml", error)) {
      names.push_back(entry.path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

RobotModel RobotModel::Load(const std::string& models_dir, const std::string& name,
                            const Pose& X_WB) {
  const std::vector<std::string> names = ListNames(models_dir);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw InputError(models_dir, "holds no robot '" + name +
                                     "' (known: " + (names.empty() ? "none" : Joined(names)) + ")");
  }
  const std::string path = models_dir + "/" + name + "/robot.yaml";
  RobotModel model = FromFile(path, X_WB);
  if (model.name() != name) {
    throw InputError(path, "name: must be the folder's, is '" + model.name() + "'");
  }
  return model;
}

RobotModel RobotModel::FromFile(const std::string& path, const Pose& X_WB) {
  const YamlReader file = YamlReader::FromFile(path);
  RobotModel model;
  model.X_WB_ = X_WB;
  model.file_ = path;
  model.name_ = file.GetString("name");

  for (const YamlReader& joint : file.GetMaps("joints")) {
    const std::string name = joint.GetString("name");
    const std::vector<std::string>& names = model.joint_names_;
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      joint.Fail("name", "is the name of an earlier joint too");
    }
    model.joint_names_.push_back(name);
    model.dh_.push_back(ReadDhRow(joint.GetMap("dh")));
    model.cos_alpha_.push_back(std::cos(model.dh_.back().alpha_rad));
    model.sin_alpha_.push_back(std::sin(model.dh_.back().alpha_rad));
    model.limits_.push_back(ReadLimits(joint.GetMap("limits")));
    const std::string key = "joints[" + std::to_string(model.joint_names_.size() - 1) + "]";
    for (const char* const part : {"name", "dh"}) model.lines_[key + "." + part] = joint.Line(part);
    for (const char* const limit : {"q_min_rad", "q_max_rad", "v_max_rad_s", "torque_max_n_m"}) {
      model.lines_[key + ".limits." + limit] = joint.GetMap("limits").Line(limit);
    }
    joint.CheckNoUnknownKeys();
  }
  const int n = model.num_joints();
  if (n < 1 || n > kMaxJoints) {
    file.Fail("joints",
              "must be 1 to " + std::to_string(kMaxJoints) + " joints, are " + std::to_string(n));
  }

  for (const YamlReader& sphere : file.GetMaps("spheres")) {
    model.spheres_.push_back(ReadSphere(sphere, n));
  }
  if (model.spheres_.empty()) file.Fail("spheres", "must not be empty");
  model.radii_m_.resize(model.num_spheres());
  for (int s = 0; s < model.num_spheres(); ++s) {
    model.radii_m_(s) = model.spheres_[static_cast<std::size_t>(s)].radius_m;
  }

  if (file.Has("tool")) model.tool_limits_ = ReadToolLimits(file.GetMap("tool"));
  if (file.Has("capsules")) {
    for (const YamlReader& capsule : file.GetMaps("capsules")) {
      model.capsules_.push_back(ReadCapsule(capsule, n));
    }
    if (model.capsules_.size() > kMaxCapsules) {
      file.Fail("capsules", "must be at most " + std::to_string(kMaxCapsules));
    }
  }

  model.configurations_ =
      ReadConfigurations(file.GetMap("configurations"), model.joint_names_, model.limits_);

  const YamlReader mount = file.GetMap("mount");
  model.mount_spheres_ = ReadSphereIndices(mount, model.num_spheres());
  model.mount_links_ = mount.GetStrings("links");
  model.lines_["mount.links"] = mount.Line("links");
  mount.CheckNoUnknownKeys();

  if (file.Has("self_collision")) {
    model.self_collision_ = ReadSelfCollision(file, model.spheres_);
  }

  const YamlReader control = file.GetMap("control");
  model.stiffness_ = ReadGains(control, "stiffness_n_m_rad", n);
  model.damping_ = ReadGains(control, "damping_n_m_s_rad", n);
  control.CheckNoUnknownKeys();

  file.CheckNoUnknownKeys();
  return model;
}

int RobotModel::LineOf(const std::string& key) const {
  const auto found = lines_.find(key);
  return found == lines_.end() ? 1 : found->second;
}

RobotModel::Chain RobotModel::ComputeChain(const Eigen::VectorXd& q) const {
  const int n = num_joints();
  if (q.size() != n) {
    throw std::invalid_argument("RobotModel: q must have " + std::to_string(n) + " values, has " +
                                std::to_string(q.size()));
  }
  Chain chain;
  chain.z_W.resize(3, n);
  chain.p_WJ.resize(3, n);
  chain.p_WL.resize(3, n);
  Eigen::Matrix3d R = X_WB_.rotation().toRotationMatrix();
  Eigen::Vector3d p = X_WB_.translation();
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const DhRow& row = dh_[k];
    chain.z_W.col(i) = R.col(2);
    chain.p_WJ.col(i) = p;
    const double c = std::cos(q(i) + row.theta_rad), s = std::sin(q(i) + row.theta_rad);
    const double ca = cos_alpha_[k], sa = sin_alpha_[k];
    const Eigen::Vector3d x = c * R.col(0) + s * R.col(1);  // after Rz
    const Eigen::Vector3d y = c * R.col(1) - s * R.col(0);
    const Eigen::Vector3d z = R.col(2);
    p += row.d_m * z + row.a_m * x;
    R.col(0) = x;
    R.col(1) = ca * y + sa * z;
    R.col(2) = ca * z - sa * y;
    chain.R_WL[k] = R;
    chain.p_WL.col(i) = p;
  }
  return chain;
}

std::vector<Pose> RobotModel::ComputeLinkPoses(const Eigen::VectorXd& q) const {
  const Chain chain = ComputeChain(q);
  std::vector<Pose> poses;
  for (int i = 0; i < num_joints(); ++i) {
    poses.emplace_back(Eigen::Quaterniond(chain.R_WL[static_cast<std::size_t>(i)]),
                       chain.p_WL.col(i));
  }
  return poses;
}

SphereCenters RobotModel::ComputeSphereCenters(const Eigen::VectorXd& q, bool with_jacobian) const {
  const Chain chain = ComputeChain(q);
  SphereCenters result;
  result.p_WS.resize(3, num_spheres());
  if (with_jacobian) result.Jq.setZero(3 * num_spheres(), num_joints());
  for (int s = 0; s < num_spheres(); ++s) {
    const CollisionSphere& sphere = spheres_[static_cast<std::size_t>(s)];
    const Eigen::Vector3d p_WS = chain.p_WL.col(sphere.link) +
                                 chain.R_WL[static_cast<std::size_t>(sphere.link)] * sphere.p_LS;
    result.p_WS.col(s) = p_WS;
    if (!with_jacobian) continue;
    for (int j = 0; j <= sphere.link; ++j) {
      const Eigen::Vector3d p_JS_W = p_WS - chain.p_WJ.col(j);
      result.Jq.block<3, 1>(3 * s, j) = Eigen::Vector3d(chain.z_W.col(j)).cross(p_JS_W);
    }
  }
  return result;
}

}  // namespace sidestep::robot
