#include "sidestep/sim/robot_agreement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/robot/limit_keys.h"
#include "sidestep/scenarios/yaml_text.h"
#include "sidestep/sim/link_frame.h"
#include "sidestep/sim/mjcf_lines.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/robot_configuration.h"
#include "sidestep/sim/tied_joints.h"
#include "sidestep/sim/world_xml.h"

namespace sidestep::sim {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-4;  // what four written digits leave, with room
constexpr int kNumConfigurations = 16;
constexpr int kPictureGroup = 2;

bool AreSame(double a, double b) {
  if (std::isinf(a) || std::isinf(b)) return a == b;
  return std::abs(a - b) <= kRounding * std::max(1.0, std::abs(a));
}

double ToSixDecimals(double value) { return std::round(value * 1e6) / 1e6 + 0.0; }  // no -0

std::string Millimetres(double length_m) {
  return scenarios::Number(std::round(length_m * 1e5) / 1e2);
}

std::string KindOf(int joint_type) {
  switch (joint_type) {
    case mjJNT_FREE:
      return "free";
    case mjJNT_BALL:
      return "a ball";
    case mjJNT_SLIDE:
      return "a slide";
    default:
      return "a hinge";
  }
}

class Comparison {
 public:
  Comparison(const robot::RobotModel& robot, const mjModel& model, const std::string& mjcf_path)
      : robot_(robot), model_(model), mjcf_(mjcf_path) {}

  void CheckJoints() {
    for (int i = 0; i < robot_.num_joints(); ++i) {
      const std::string& name = robot_.joint_names()[static_cast<std::size_t>(i)];
      const int joint = mj_name2id(&model_, mjOBJ_JOINT, name.c_str());
      if (joint < 0) {
        FailInYaml(KeyOf(i) + ".name",
                   "'" + name + "' is no joint of " + mjcf_.path() + " (there: " + Joints() + ")");
      }
      joints_.push_back(joint);
      const bool slides = JointOf(i).kind == robot::JointKind::kPrismatic;
      if (model_.jnt_type[joint] != (slides ? mjJNT_SLIDE : mjJNT_HINGE)) {
        FailInMjcf("joint", name,
                   "is " + KindOf(model_.jnt_type[joint]) + ", must be " +
                       (slides ? "a slide: " + InYaml(i) + " slides"
                               : "a hinge: " + InYaml(i) + " turns"));
      }
      if (i > 0 && joints_[static_cast<std::size_t>(i) - 1] > joint) {
        FailInYaml(KeyOf(i) + ".name", "'" + name + "' comes before '" +
                                           robot_.joint_names()[static_cast<std::size_t>(i) - 1] +
                                           "' in " + At("joint", name));
      }
    }
    for (int i = 0; i < robot_.num_joints(); ++i) {
      CheckRange(i, joints_[static_cast<std::size_t>(i)]);
    }
    const std::vector<int> mimics = CheckMimics();
    for (int joint = 0; joint < model_.njnt; ++joint) {
      if (std::count(joints_.begin(), joints_.end(), joint) > 0) continue;
      if (std::count(mimics.begin(), mimics.end(), joint) > 0) continue;
      const std::string name = NameOf(mjOBJ_JOINT, joint);
      FailInMjcf("joint", name,
                 "is not in " + robot_.file() + ": nothing would hold it; name it there or fix it");
    }
  }

  void CheckMotors() {
    for (int motor = 0; motor < model_.nu; ++motor) {
      const bool drives =
          model_.actuator_trntype[motor] == mjTRN_JOINT &&
          std::count(joints_.begin(), joints_.end(), model_.actuator_trnid[2 * motor]) > 0;
      const std::string name = NameOf(mjOBJ_ACTUATOR, motor);
      if (!drives) FailInMjcf("", name, "drives no joint of " + robot_.file());
    }
    for (int i = 0; i < robot_.num_joints(); ++i) CheckMotorOf(i);
  }

  // What touches nothing is a picture and is judged in no verdict. That it is meant as one is told
  // by its group; what touches only some things would be judged against all.
  void CheckGeoms() const {
    for (int geom = 0; geom < model_.ngeom; ++geom) {
      const int body = model_.geom_bodyid[geom];
      if (!IsOfRobot(body)) continue;
      const int type = model_.geom_contype[geom], affinity = model_.geom_conaffinity[geom];
      if (type == 1 && affinity == 1) continue;
      if (type == 0 && affinity == 0 && model_.geom_group[geom] == kPictureGroup) continue;
      const std::string link = NameOf(mjOBJ_BODY, body);
      const int number = geom - model_.body_geomadr[body];
      throw InputError(
          mjcf_.path(), mjcf_.FindChild("body", link, "geom", number),
          "geom " + std::to_string(number + 1) + " of body '" + link + "'",
          type == 0 && affinity == 0
              ? "touches nothing (contype and conaffinity 0): a solid has 1 and 1, a picture "
                "belongs to group 2"
              : "must have contype and conaffinity 1, or 0 as a picture of group 2; has " +
                    std::to_string(type) + " and " + std::to_string(affinity));
    }
  }

  // A link that is seen can also touch.
  void CheckPictures() const {
    std::set<int> solid;  // links, by the body that stands for all that are fixed to it
    for (int geom = 0; geom < model_.ngeom; ++geom) {
      const int body = model_.geom_bodyid[geom];
      if (IsOfRobot(body) && model_.geom_contype[geom] != 0) solid.insert(model_.body_weldid[body]);
    }
    for (int geom = 0; geom < model_.ngeom; ++geom) {
      const int body = model_.geom_bodyid[geom];
      if (!IsOfRobot(body) || solid.count(model_.body_weldid[body]) > 0) continue;
      FailInMjcf("body", NameOf(mjOBJ_BODY, body),
                 "is only a picture: neither it nor what is fixed to it has a geom that can touch");
    }
  }

  void CheckLinks() const {
    for (const std::string& link : robot_.mount_links()) {
      if (mj_name2id(&model_, mjOBJ_BODY, link.c_str()) < 0) {
        FailInYaml("mount.links", "'" + link + "' is no body of " + mjcf_.path());
      }
    }
  }

  // Each joint by itself, seen from its parent's frame: so one that is wrong is told, and none
  // after it.
  void CheckKinematics() const {
    const std::vector<robot::Joint>& joints = robot_.joints();
    std::vector<LinkFrame> frames;
    for (std::size_t i = 0; i < joints.size(); ++i) frames.push_back(FindFrame(i));
    const MujocoDataPtr data = MakeMujocoData(model_);
    std::vector<Difference> worst(joints.size());
    RandomStream random(1, "robot agreement");
    for (int k = 0; k < kNumConfigurations; ++k) {
      const Eigen::VectorXd q = DrawConfiguration(robot_, random);
      for (int i = 0; i < robot_.num_joints(); ++i) {
        const int joint = joints_[static_cast<std::size_t>(i)];
        data->qpos[model_.jnt_qposadr[joint]] = q(i);
      }
      FollowLeaders(model_, data.get());
      mj_kinematics(&model_, data.get());
      const std::vector<Pose> X_WL = robot_.ComputeLinkPoses(q);
      const Pose X_WB_mjcf = BaseIn(*data);
      for (std::size_t i = 0; i < joints.size(); ++i) {
        const int parent = joints[i].parent;
        const Pose X_WP = parent < 0 ? robot_.X_WB() : X_WL[static_cast<std::size_t>(parent)];
        const Pose X_WP_mjcf =
            parent < 0 ? X_WB_mjcf : PoseOf(*data, frames[static_cast<std::size_t>(parent)]);
        const Pose X_TP = UnturnedBy(joints[i], q) * X_WP.Inverse();
        const Pose X_TP_mjcf = UnturnedBy(joints[i], q) * X_WP_mjcf.Inverse();
        const Difference difference(X_TP * X_WL[i], X_TP_mjcf * PoseOf(*data, frames[i]));
        if (difference.size() > worst[i].size()) worst[i] = difference;
      }
    }
    for (std::size_t i = 0; i < joints.size(); ++i) CheckFrame(i, frames[i], worst[i]);
  }

 private:
  // What robot.yaml calls a joint that mimics is tied to the one that moves it in the MJCF, and
  // nothing else is. @return those joints of the model.
  std::vector<int> CheckMimics() const {
    std::vector<int> mimics;
    std::set<int> wanted;
    for (std::size_t i = 0; i < robot_.joints().size(); ++i) {
      const robot::Joint& joint = robot_.joints()[i];
      if (joint.coordinate < 0 || MovingJoint(joint.coordinate) == static_cast<int>(i)) continue;
      const std::string& leader = robot_.joint_names()[static_cast<std::size_t>(joint.coordinate)];
      const int id = mj_name2id(&model_, mjOBJ_JOINT, joint.name.c_str());
      if (id < 0) {
        FailInYaml(KeyOfJoint(i) + ".name", "'" + joint.name + "' is no joint of " + mjcf_.path() +
                                                " (there: " + Joints() + ")");
      }
      const int tie = TieOf(id);
      if (tie < 0) {
        FailInMjcf("joint", joint.name,
                   "must be tied to '" + leader + "', which it mimics by " + InYamlOf(i, ".name") +
                       ": <equality><joint joint1=\"" + joint.name + "\" joint2=\"" + leader +
                       "\" polycoef=\"" + scenarios::Number(joint.offset) + " " +
                       scenarios::Number(joint.multiplier) + " 0 0 0\"/>");
      }
      CheckTie(i, tie, leader);
      mimics.push_back(id);
      wanted.insert(tie);
    }
    for (int tie = 0; tie < model_.neq; ++tie) {
      if (wanted.count(tie) > 0) continue;
      const std::string name = NameOf(mjOBJ_JOINT, model_.eq_obj1id[tie]);
      throw InputError(mjcf_.path(), mjcf_.Find("joint", "joint1", name), "joint '" + name + "'",
                       "is tied, which planning takes for free: it mimics nothing in " +
                           robot_.file() + "; leave it out");
    }
    return mimics;
  }

  // The only tie of a joint; -1 if it has none or several.
  int TieOf(int joint) const {
    int found = -1;
    for (int tie = 0; tie < model_.neq; ++tie) {
      if (model_.eq_type[tie] != mjEQ_JOINT || model_.eq_obj1id[tie] != joint) continue;
      if (found >= 0) return -1;
      found = tie;
    }
    return found;
  }

  void CheckTie(std::size_t i, int tie, const std::string& leader) const {
    const robot::Joint& joint = robot_.joints()[i];
    const double* const given = model_.eq_data + mjNEQDATA * tie;
    const double wanted[] = {joint.offset, joint.multiplier, 0, 0, 0};
    const int other = model_.eq_obj2id[tie];
    bool is_same = model_.eq_active[tie] != 0 && other >= 0 && NameOf(mjOBJ_JOINT, other) == leader;
    for (int power = 0; power < 5; ++power) {
      is_same = is_same && AreSame(given[power], wanted[power]);
    }
    if (is_same) return;
    throw InputError(mjcf_.path(), mjcf_.Find("joint", "joint1", joint.name),
                     "joint '" + joint.name + "'",
                     "must be tied as it mimics by " + InYamlOf(i, ".name") + ": joint2=\"" +
                         leader + "\" polycoef=\"" + scenarios::Number(joint.offset) + " " +
                         scenarios::Number(joint.multiplier) + " 0 0 0\"");
  }

  // Between where robot.yaml and where the MJCF put a frame.
  struct Difference {
    Difference() = default;
    Difference(const Pose& in_yaml, const Pose& in_mjcf)
        : p_yaml(in_yaml.translation()),
          p_mjcf(in_mjcf.translation()),
          apart_m((p_yaml - p_mjcf).norm()),
          turned_rad(in_yaml.rotation().angularDistance(in_mjcf.rotation())) {}
    double size() const { return std::max(apart_m, turned_rad); }

    Eigen::Vector3d p_yaml = Eigen::Vector3d::Zero(), p_mjcf = Eigen::Vector3d::Zero();
    double apart_m = 0, turned_rad = 0;
  };

  LinkFrame FindFrame(std::size_t i) const {
    const LinkFrame frame = FindLinkFrame(robot_, model_, i);
    if (frame.id >= 0) return frame;
    const robot::Joint& joint = robot_.joints()[i];
    if (!joint.dh) {
      FailInYaml(KeyOfJoint(i) + (robot_.LineOf(KeyOfJoint(i) + ".link") > 1 ? ".link" : ".name"),
                 "'" + joint.link + "' is no body and no site of " + mjcf_.path());
    }
    throw InputError(mjcf_.path(), mjcf_.Find("joint", "name", joint.name),
                     "site '" + frame.name + "'",
                     "is missing: it marks the frame after " + KeyOfJoint(i) + ".dh of " +
                         InYamlOf(i, ".dh") + ", beyond joint '" + joint.name + "'");
  }

  // Takes the turn of a row of a table out: seen so, the frame after it stands at (a, 0, d)
  // whatever q is. Identity for other joints.
  static Pose UnturnedBy(const robot::Joint& joint, const Eigen::VectorXd& q) {
    if (!joint.dh || joint.kind != robot::JointKind::kRevolute) return Pose();
    const double angle = joint.multiplier * q(joint.coordinate) + joint.offset;
    const Eigen::AngleAxisd turn(angle + joint.dh->theta_rad, Eigen::Vector3d::UnitZ());
    return Pose(Eigen::Quaterniond(turn), Eigen::Vector3d::Zero()).Inverse();
  }

  void CheckFrame(std::size_t i, const LinkFrame& frame, const Difference& difference) const {
    if (difference.size() <= kRounding) return;
    const bool is_row = robot_.joints()[i].dh.has_value();
    const std::string what = (frame.is_site ? "the site '" : "the body '") + frame.name + "'";
    FailInYaml(KeyOfJoint(i) + (is_row ? ".dh" : ".origin"),
               "puts its frame at " + scenarios::List(difference.p_yaml.unaryExpr(&ToSixDecimals)) +
                   ", " + what + " of " + At(frame.is_site ? "site" : "body", frame.name) +
                   " is at " + scenarios::List(difference.p_mjcf.unaryExpr(&ToSixDecimals)) + ": " +
                   Millimetres(difference.apart_m) + " mm and " +
                   scenarios::Number(ToSixDecimals(difference.turned_rad)) +
                   " rad apart (seen from the " +
                   (is_row ? "frame before, turned with the joint)" : "parent link)"));
  }

  void CheckRange(int i, int joint) const {
    const robot::JointLimits& limits = robot_.limits()[static_cast<std::size_t>(i)];
    const bool limited = model_.jnt_limited[joint] != 0;
    const robot::LimitKeys keys = robot::LimitKeysOf(JointOf(i).kind);
    CheckLimit(i, keys.q_min, limits.q_min, limited ? model_.jnt_range[2 * joint] : -kNoLimit,
               "joint", "range");
    CheckLimit(i, keys.q_max, limits.q_max, limited ? model_.jnt_range[2 * joint + 1] : kNoLimit,
               "joint", "range");
    if (!std::isfinite(limits.v_max)) {
      FailInYaml(KeyOf(i) + ".limits." + keys.v_max,
                 "is not given: nothing can be moved without a greatest speed");
    }
  }

  void CheckMotorOf(int i) const {
    const auto row = static_cast<std::size_t>(i);
    const std::string& joint = robot_.joint_names()[row];
    int motor = -1;
    for (int k = 0; k < model_.nu; ++k) {
      if (model_.actuator_trnid[2 * k] != joints_[row]) continue;
      if (motor >= 0) {
        FailInMjcf("", NameOf(mjOBJ_ACTUATOR, k), "is a second motor of the joint '" + joint + "'");
      }
      motor = k;
    }
    if (motor < 0) {
      FailInMjcf("joint", joint, "has no motor, which " + InYaml(i) + " needs");
    }
    const bool is_plain = model_.actuator_dyntype[motor] == mjDYN_NONE &&
                          model_.actuator_gaintype[motor] == mjGAIN_FIXED &&
                          model_.actuator_biastype[motor] == mjBIAS_NONE &&
                          model_.actuator_gainprm[mjNGAIN * motor] == 1 &&
                          model_.actuator_gear[6 * motor] == 1;
    if (!is_plain) {
      FailInMjcf("", NameOf(mjOBJ_ACTUATOR, motor), "must be a <motor> of gear 1");
    }
    double least = -kNoLimit, most = kNoLimit;
    const char* attribute = "ctrlrange";
    if (model_.actuator_ctrllimited[motor] != 0) {
      least = model_.actuator_ctrlrange[2 * motor];
      most = model_.actuator_ctrlrange[2 * motor + 1];
    }
    if (model_.actuator_forcelimited[motor] != 0) {
      if (model_.actuator_forcerange[2 * motor + 1] < most) attribute = "forcerange";
      least = std::max(least, model_.actuator_forcerange[2 * motor]);
      most = std::min(most, model_.actuator_forcerange[2 * motor + 1]);
    }
    if (!AreSame(-least, most)) {
      FailInMjcf("", NameOf(mjOBJ_ACTUATOR, motor),
                 "must have the same limit both ways, has " + scenarios::Number(least) + " and " +
                     scenarios::Number(most));
    }
    CheckLimit(i, robot::LimitKeysOf(JointOf(i).kind).torque_max, robot_.limits()[row].torque_max,
               most, "", attribute);
  }

  // One limit of joint i, which may be infinite on either side: there, nothing is written.
  void CheckLimit(int i, const std::string& key, double in_yaml, double in_mjcf,
                  const std::string& tag, const std::string& attribute) const {
    if (AreSame(in_yaml, in_mjcf)) return;
    const std::string& joint = robot_.joint_names()[static_cast<std::size_t>(i)];
    const std::string where =
        tag.empty() ? mjcf_.path() + ":" + std::to_string(mjcf_.Find("", "joint", joint))
                    : At(tag, joint);
    FailInYaml(KeyOf(i) + ".limits." + key,
               (std::isinf(in_yaml) ? "is not given" : "is " + scenarios::Number(in_yaml)) +
                   ", but " +
                   (std::isinf(in_mjcf) ? where + " has no " + attribute
                                        : "the " + attribute + " of " + where + " says " +
                                              scenarios::Number(ToSixDecimals(in_mjcf))));
  }

  bool IsOfRobot(int body) const {
    const int robot = mj_name2id(&model_, mjOBJ_BODY, kRobotBody);
    return robot < 0 || model_.body_rootid[body] == robot;  // alone, or in a world
  }

  Pose BaseIn(const mjData& data) const {
    const int body = mj_name2id(&model_, mjOBJ_BODY, kRobotBody);
    return body < 0 ? Pose() : PoseOf(data, {false, body, kRobotBody});
  }

  // The joint that number i of a configuration moves.
  const robot::Joint& JointOf(int i) const {
    return robot_.joints()[static_cast<std::size_t>(MovingJoint(i))];
  }
  int MovingJoint(int i) const { return robot_.moving_joints()[static_cast<std::size_t>(i)]; }
  std::string KeyOf(int i) const { return KeyOfJoint(static_cast<std::size_t>(MovingJoint(i))); }
  std::string InYaml(int i, const std::string& key = ".name") const {
    return InYamlOf(static_cast<std::size_t>(MovingJoint(i)), key);
  }
  static std::string KeyOfJoint(std::size_t i) { return "joints[" + std::to_string(i) + "]"; }
  std::string InYamlOf(std::size_t i, const std::string& key) const {
    return robot_.file() + ":" + std::to_string(robot_.LineOf(KeyOfJoint(i) + key));
  }
  std::string At(const std::string& tag, const std::string& name) const {
    return mjcf_.path() + ":" + std::to_string(mjcf_.Find(tag, "name", name));
  }
  std::string NameOf(mjtObj type, int id) const {
    const char* const name = mj_id2name(&model_, type, id);
    return name == nullptr ? "" : name;
  }
  std::string Joints() const {
    std::string list;
    for (int joint = 0; joint < model_.njnt; ++joint) {
      list += (list.empty() ? "" : ", ") + NameOf(mjOBJ_JOINT, joint);
    }
    return list.empty() ? "none" : list;
  }

  [[noreturn]] void FailInYaml(const std::string& key, const std::string& why) const {
    throw InputError(robot_.file(), robot_.LineOf(key), key, why);
  }
  // `tag` may be empty: what has the name, whatever it is (a motor, a position, ...).
  [[noreturn]] void FailInMjcf(const std::string& tag, const std::string& name,
                               const std::string& why) const {
    throw InputError(mjcf_.path(), mjcf_.Find(tag, "name", name),
                     (tag.empty() ? "actuator" : tag) + " '" + name + "'", why);
  }

  const robot::RobotModel& robot_;
  const mjModel& model_;
  const MjcfLines mjcf_;
  std::vector<int> joints_;  // in the model, of each joint of robot.yaml
};

}  // namespace

void CheckAgreement(const robot::RobotModel& robot, const mjModel& model,
                    const std::string& mjcf_path) {
  Comparison comparison(robot, model, mjcf_path);
  comparison.CheckJoints();
  comparison.CheckMotors();
  comparison.CheckGeoms();
  comparison.CheckPictures();
  comparison.CheckLinks();
  comparison.CheckKinematics();
}

}  // namespace sidestep::sim
