#include "sidestep/import/arm_from_urdf.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <set>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/import/convex_hull.h"
#include "sidestep/import/inertia.h"
#include "sidestep/import/joint_choice.h"
#include "sidestep/import/solid_reader.h"
#include "sidestep/import/urdf_file.h"
#include "sidestep/import/urdf_pose.h"

namespace sidestep::import {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDensity_kg_m3 = 1000;  // of what is given a weight that it lacks
constexpr double kJerkRamp = 0.1;        // of the ramp of speed, in which acceleration comes

bool IsFinite(const urdf::Joint& joint) { return joint.type != urdf::Joint::CONTINUOUS; }

class Maker {
 public:
  Maker(const UrdfFile& file, const ArmChoices& choices)
      : file_(file), choices_(choices), choice_(ChooseJoints(file, choices)) {
    imported_.notes = file.notes;
  }

  ImportedArm Make() {
    arm_.name = choices_.name;
    arm_.source = file_.path;
    AddLink(choice_.base);
    for (const std::string& name : choice_.joints) AddJoint(*file_.model->joints_.at(name));
    arm_.tool_link = NameOfLink(choice_.tip);
    if (arm_.limits.size() > 16) {
      throw InputError(file_.path,
                       std::to_string(arm_.limits.size()) +
                           " joints move, at most 16 may; choose a --tip or --fix some");
    }
    bool is_solid = false;
    for (const robot::ArmLink& link : arm_.links) is_solid = is_solid || !link.solids.empty();
    if (!is_solid) {
      throw InputError(file_.path,
                       "none of its links has a collision; --visuals-as-collisions "
                       "takes what is drawn");
    }
    CheckWeights();
    Tell();
    return std::move(imported_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what, const std::string& key,
                         const std::string& why) const {
    throw InputError(file_.path, file_.LineOf(what), key, why);
  }
  void Note(const std::string& text) { imported_.notes.push_back(text); }

  // MuJoCo and the world that a robot stands in have these names for themselves.
  std::string NameOfLink(const std::string& link) {
    static const std::set<std::string> kTaken = {"world", "robot", "floor"};
    if (kTaken.count(link) == 0) return link;
    if (renamed_.insert(link).second) {
      Note("link '" + link + "' is called '" + link + "_link': the world has that name itself");
    }
    return link + "_link";
  }

  void AddLink(const std::string& name) {
    const urdf::Link& from = *file_.model->links_.at(name);
    robot::ArmLink link;
    link.name = NameOfLink(name);
    for (const robot::ArmLink& other : arm_.links) {
      if (other.name == link.name) Fail("link " + name, "link '" + name + "'", "is there twice");
    }
    if (from.inertial != nullptr) link.inertia = InertiaOf(from);
    link.solids = ReadSolids(file_, from, choices_, &imported_.notes);
    arm_.links.push_back(std::move(link));
  }

  std::optional<robot::LinkInertia> InertiaOf(const urdf::Link& link) {
    const urdf::Inertial& from = *link.inertial;
    const std::string key = "link '" + link.name + "'", what = "inertial " + link.name;
    if (!(from.mass > 0)) {
      if (from.mass == 0 && choices_.repair_inertia) {
        Note(key + ": its mass is 0: taken as none given");
        return std::nullopt;
      }
      Fail(what, key + ": mass",
           "must be > 0, is " + ShortestText(from.mass) +
               (from.mass == 0 ? " (--repair-inertia takes that as none given)" : ""));
    }
    const Pose X_LI = PoseOf(from.origin);
    Eigen::Matrix3d I;
    I << from.ixx, from.ixy, from.ixz, from.ixy, from.iyy, from.iyz, from.ixz, from.iyz, from.izz;
    if (const std::string why = WhyNoInertia(I); !why.empty()) {
      if (!choices_.repair_inertia) {
        Fail(what, key + ": inertia", why + " (--repair-inertia mends that)");
      }
      I = RepairedInertia(I);
      Note(key + ": its inertia " + why + "; mended to " + ShortestText(I(0, 0)) + ", " +
           ShortestText(I(1, 1)) + ", " + ShortestText(I(2, 2)) + " about its own axes");
    }
    const Eigen::Matrix3d R = X_LI.rotation().toRotationMatrix();
    return robot::LinkInertia{from.mass, X_LI.translation(), R * I * R.transpose()};
  }

  int NumberOf(const std::string& link) const {
    for (std::size_t i = 0; i < arm_.links.size(); ++i) {
      if (arm_.links[i].name == link) return static_cast<int>(i) - 1;
    }
    return -1;
  }

  void AddJoint(const urdf::Joint& from) {
    const JointRole& role = choice_.roles.at(from.name);
    robot::Joint joint;
    joint.name = from.name;
    joint.link = NameOfLink(from.child_link_name);
    joint.parent = NumberOf(NameOfLink(from.parent_link_name));
    joint.X_PJ = PoseOf(from.parent_to_joint_origin_transform);
    joint.axis_J = Eigen::Vector3d(from.axis.x, from.axis.y, from.axis.z);
    if (from.type != urdf::Joint::FIXED) joint.axis_J.normalize();
    joint.kind = from.type == urdf::Joint::FIXED       ? robot::JointKind::kFixed
                 : from.type == urdf::Joint::PRISMATIC ? robot::JointKind::kPrismatic
                                                       : robot::JointKind::kRevolute;
    robot::JointDynamics dynamics;
    if (from.dynamics != nullptr) {
      dynamics.damping = from.dynamics->damping;
      dynamics.friction = from.dynamics->friction;
    }
    switch (role.kind) {
      case JointRole::Kind::kHeld:
        Hold(from, role.position, &joint);
        dynamics = {};
        break;
      case JointRole::Kind::kMoves:
        joint.coordinate = static_cast<int>(arm_.limits.size());
        arm_.limits.push_back(LimitsOf(from));
        coordinates_[from.name] = joint.coordinate;
        break;
      case JointRole::Kind::kMimics:
        joint.coordinate = coordinates_.at(role.leader);
        joint.multiplier = role.multiplier;
        joint.offset = role.offset;
    }
    if (dynamics.damping < 0 || dynamics.friction < 0) {
      Fail("joint " + from.name, "joint '" + from.name + "': dynamics", "must be >= 0");
    }
    arm_.joints.push_back(joint);
    arm_.dynamics.push_back(dynamics);
    AddLink(from.child_link_name);
  }

  void Hold(const urdf::Joint& from, double position, robot::Joint* joint) {
    if (joint->kind == robot::JointKind::kFixed) return;
    if (position != 0) {
      joint->X_PJ =
          joint->X_PJ * (joint->kind == robot::JointKind::kPrismatic
                             ? Pose::Translation(position * joint->axis_J)
                             : Pose(Eigen::Quaterniond(Eigen::AngleAxisd(position, joint->axis_J)),
                                    Eigen::Vector3d::Zero()));
    }
    joint->kind = robot::JointKind::kFixed;
    held_.push_back(from.name + " at " + ShortestText(position));
    const bool limited = IsFinite(from) && from.limits != nullptr;
    if (limited && (position < from.limits->lower || position > from.limits->upper)) {
      Note("joint '" + from.name + "' is held at " + ShortestText(position) +
           ", outside of its limits " + ShortestText(from.limits->lower) + " to " +
           ShortestText(from.limits->upper) + "; --fix " + from.name + "=VALUE holds it elsewhere");
    }
  }

  robot::JointLimits LimitsOf(const urdf::Joint& from) {
    robot::JointLimits limits;
    limits.q_min = -kInfinity;
    limits.q_max = limits.v_max = limits.a_max = limits.jerk_max = kInfinity;
    limits.torque_max = limits.torque_rate_max = kInfinity;
    const std::string what = "joint " + from.name, key = "joint '" + from.name + "': limit";
    if (from.limits != nullptr) {
      if (IsFinite(from)) {
        limits.q_min = from.limits->lower;
        limits.q_max = from.limits->upper;
        if (!(limits.q_min < limits.q_max)) {
          Fail(what, key,
               "lower must be < upper, they are " + ShortestText(limits.q_min) + " and " +
                   ShortestText(limits.q_max) + " (--fix " + from.name + "=0 holds it still)");
        }
      }
      if (from.limits->velocity < 0) Fail(what, key, "velocity must not be negative");
      if (from.limits->effort < 0) Fail(what, key, "effort must not be negative");
      if (from.limits->velocity > 0) limits.v_max = from.limits->velocity;
      if (from.limits->effort > 0) limits.torque_max = from.limits->effort;
      if (from.limits->effort == 0) {
        Note("joint '" + from.name + "': its effort is 0: taken as none given, it has no limit");
      }
    }
    if (!std::isfinite(limits.v_max)) {
      if (!choices_.v_max) {
        Fail(what, key,
             "velocity is not given or 0, and nothing moves without a greatest speed; "
             "give one by --velocity");
      }
      limits.v_max = *choices_.v_max;
    }
    if (choices_.ramp_s) {
      limits.a_max = limits.v_max / *choices_.ramp_s;
      limits.jerk_max = limits.a_max / (kJerkRamp * *choices_.ramp_s);
    }
    return limits;
  }

  // What a joint moves must weigh something, it or what is fixed to it.
  void CheckWeights() {
    for (std::size_t i = 0; i < arm_.joints.size(); ++i) {
      if (arm_.joints[i].kind == robot::JointKind::kFixed) continue;
      const std::vector<int> links = FixedTo(static_cast<int>(i));
      bool weighs = false;
      for (const int link : links) weighs = weighs || arm_.LinkOf(link).inertia.has_value();
      if (weighs) continue;
      const std::string& name = arm_.joints[i].name;
      if (!choices_.repair_inertia || !GiveWeight(links)) {
        Fail("joint " + name, "joint '" + name + "'",
             "moves the link '" + arm_.joints[i].link +
                 "', which has no mass, nor has what is fixed to it (--repair-inertia gives it "
                 "that of water of its shape)");
      }
    }
  }

  std::vector<int> FixedTo(int link) const {
    std::vector<int> links = {link};
    for (std::size_t i = 0; i < arm_.joints.size(); ++i) {
      const robot::Joint& joint = arm_.joints[i];
      const bool is_there = std::find(links.begin(), links.end(), joint.parent) != links.end();
      if (joint.kind == robot::JointKind::kFixed && is_there) links.push_back(static_cast<int>(i));
    }
    return links;
  }

  // By the boxes around the solids.
  bool GiveWeight(const std::vector<int>& links) {
    for (const int number : links) {
      robot::ArmLink& link = arm_.links[static_cast<std::size_t>(number + 1)];
      if (link.solids.empty()) continue;
      Eigen::AlignedBox3d box;
      double volume_m3 = 0;
      for (const robot::LinkSolid& solid : link.solids) {
        const auto* const hull = std::get_if<robot::HullSolid>(&solid.form);
        Eigen::Vector3d low, high;
        if (hull != nullptr) {
          low = hull->vertices.rowwise().minCoeff();
          high = hull->vertices.rowwise().maxCoeff();
          volume_m3 += VolumeOf_m3(*hull);
        } else {
          high = HalfExtents(std::get<Shape>(solid.form));
          low = -high;
          volume_m3 += 8 * high.prod();
        }
        for (int corner = 0; corner < 8; ++corner) {
          box.extend(solid.X_LS * Eigen::Vector3d((corner & 1) != 0 ? low.x() : high.x(),
                                                  (corner & 2) != 0 ? low.y() : high.y(),
                                                  (corner & 4) != 0 ? low.z() : high.z()));
        }
      }
      const double mass = kDensity_kg_m3 * volume_m3;
      const Eigen::Vector3d squares = box.sizes().cwiseAbs2();
      Eigen::Vector3d moments = mass / 12 * (squares.sum() - squares.array()).matrix();
      link.inertia = robot::LinkInertia{mass, box.center(),
                                        moments.cwiseMax(1e-9).asDiagonal().toDenseMatrix()};
      Note("link '" + link.name + "' has no mass: given " + ShortestText(mass) +
           " kg, that of water of its shape");
      return true;
    }
    return false;
  }

  void Tell() {
    std::string chain = "from '" + NameOfLink(choice_.base) + "' to '" + arm_.tool_link + "', " +
                        std::to_string(arm_.limits.size()) + " joints move";
    if (!choice_.other_leaves.empty()) {
      chain += "; further ends: " + Joined(choice_.other_leaves);
    }
    imported_.notes.insert(imported_.notes.begin(), chain);
    if (!held_.empty()) Note("held: " + Joined(held_));
    if (!choices_.ramp_s) {
      Note(
          "a URDF knows no limits of acceleration and jerk: none are written "
          "(--ramp-s derives some)");
    }
    imported_.arm = std::move(arm_);
  }

  const UrdfFile& file_;
  const ArmChoices& choices_;
  const JointChoice choice_;
  robot::ArmDescription arm_;
  ImportedArm imported_;
  std::map<std::string, int> coordinates_;  // of joints that move
  std::set<std::string> renamed_;
  std::vector<std::string> held_;
};

}  // namespace

ImportedArm ArmFromUrdf(const std::string& path, const ArmChoices& choices) {
  const UrdfFile file = ReadUrdf(path);
  return Maker(file, choices).Make();
}

}  // namespace sidestep::import
