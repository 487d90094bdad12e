#include "sidestep/import/arm_of_tree.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <set>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/import/joint_choice.h"
#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {
namespace {

constexpr double kDensity_kg_m3 = 1000;  // of what is given a weight that it lacks
constexpr double kJerkRamp = 0.1;        // of the ramp of speed, in which acceleration comes

class Maker {
 public:
  Maker(const robot::RobotTree& tree, const ArmChoices& choices)
      : tree_(tree), choices_(choices), choice_(ChooseJoints(tree, choices)) {
    imported_.notes = tree.notes;
  }

  ImportedArm Make() {
    arm_.name = choices_.name;
    arm_.source = tree_.file;
    AddLink(choice_.base);
    for (const std::string& name : choice_.joints) AddJoint(*tree_.FindJoint(name));
    arm_.tool_link = NameOfLink(choice_.tip);
    for (const auto& [first, second] : tree_.without_contact) {
      const int a = NumberOf(NameOfLink(first)), b = NumberOf(NameOfLink(second));
      if (a != b) arm_.without_contact.push_back({std::min(a, b), std::max(a, b)});
    }
    if (arm_.limits.size() > robot::RobotModel::kMaxJoints) {
      throw InputError(tree_.file,
                       std::to_string(arm_.limits.size()) +
                           " joints move, at most 16 may; choose a --tip or --fix some");
    }
    bool is_solid = false;
    for (const robot::ArmLink& link : arm_.links) is_solid = is_solid || !link.solids.empty();
    if (!is_solid) {
      throw InputError(tree_.file,
                       "none of its links has a collision; --visuals-as-collisions "
                       "takes what is drawn");
    }
    CheckSize();
    CheckWeights();
    Tell();
    return std::move(imported_);
  }

 private:
  [[noreturn]] void Fail(int line, const std::string& key, const std::string& why) const {
    throw InputError(tree_.file, line, key, why);
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
    const robot::TreeLink& from = *tree_.FindLink(name);
    robot::ArmLink link = from.link;
    link.name = NameOfLink(name);
    for (const robot::ArmLink& other : arm_.links) {
      if (other.name == link.name) Fail(from.line, "link '" + name + "'", "is there twice");
    }
    if (!link.inertia && !link.solids.empty()) weightless_.push_back(link.name);
    arm_.links.push_back(std::move(link));
  }

  // Of a link's joint; the base's for one that is no part of the arm.
  int NumberOf(const std::string& link) const {
    for (std::size_t i = 0; i < arm_.links.size(); ++i) {
      if (arm_.links[i].name == link) return static_cast<int>(i) - 1;
    }
    return -1;
  }

  void AddJoint(const robot::TreeJoint& from) {
    const JointRole& role = choice_.roles.at(from.name);
    robot::Joint joint;
    joint.name = from.name;
    joint.link = NameOfLink(from.child);
    joint.parent = NumberOf(NameOfLink(from.parent));
    joint.kind = from.kind;
    joint.X_PJ = from.X_PJ;
    joint.axis_J = from.axis_J;
    robot::JointDynamics dynamics = from.dynamics;
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
    arm_.joints.push_back(joint);
    arm_.dynamics.push_back(dynamics);
    AddLink(from.child);
  }

  void Hold(const robot::TreeJoint& from, double position, robot::Joint* joint) {
    if (joint->kind == robot::JointKind::kFixed) return;
    if (position != 0) {
      joint->X_PJ = joint->X_PJ * robot::MotionOf(joint->kind, joint->axis_J, position);
    }
    joint->kind = robot::JointKind::kFixed;
    held_.push_back(from.name + " at " + ShortestText(position));
    if (position < from.q_min || position > from.q_max) {
      Note("joint '" + from.name + "' is held at " + ShortestText(position) +
           ", outside of its limits " + ShortestText(from.q_min) + " to " +
           ShortestText(from.q_max) + "; --fix " + from.name + "=VALUE holds it elsewhere");
    }
  }

  robot::JointLimits LimitsOf(const robot::TreeJoint& from) {
    const std::string key = "joint '" + from.name + "': limit";
    robot::JointLimits limits;
    limits.q_min = from.q_min;
    limits.q_max = from.q_max;
    limits.v_max = from.v_max;
    limits.torque_max = from.torque_max;
    limits.a_max = limits.jerk_max = limits.torque_rate_max =
        std::numeric_limits<double>::infinity();
    if (!(limits.q_min < limits.q_max)) {
      Fail(from.line, key,
           "lower must be < upper, they are " + ShortestText(limits.q_min) + " and " +
               ShortestText(limits.q_max) + " (--fix " + from.name + "=0 holds it still)");
    }
    if (!std::isfinite(limits.torque_max)) unlimited_.push_back(from.name);
    if (!std::isfinite(limits.v_max)) {
      if (!choices_.v_max) {
        Fail(from.line, key,
             "velocity is not given or 0, and nothing moves without a greatest speed; give one by "
             "--velocity");
      }
      limits.v_max = *choices_.v_max;
    }
    if (choices_.ramp_s) {
      limits.a_max = limits.v_max / *choices_.ramp_s;
      limits.jerk_max = limits.a_max / (kJerkRamp * *choices_.ramp_s);
    }
    return limits;
  }

  // What robot.yaml and MJCF hold at most.
  void CheckSize() const {
    constexpr std::size_t kMostJoints = 128, kMostSolids = 1000;
    constexpr int kDeepest = 90;
    const auto fail = [this](const std::string& what, int most) {
      throw InputError(tree_.file, what + ", at most " + std::to_string(most) +
                                       " may: choose a --base further on");
    };
    if (arm_.joints.size() > kMostJoints) {
      fail(std::to_string(arm_.joints.size()) + " joints are below '" + choice_.base + "'",
           kMostJoints);
    }
    std::size_t solids = 0;
    for (const robot::ArmLink& link : arm_.links) solids += link.solids.size();
    if (solids > kMostSolids) {
      fail(std::to_string(solids) + " solids are below '" + choice_.base + "'", kMostSolids);
    }
    std::vector<int> depths;
    for (const robot::Joint& joint : arm_.joints) {
      const int above = joint.parent < 0 ? 0 : depths[static_cast<std::size_t>(joint.parent)];
      depths.push_back(above + 1);
      if (depths.back() > kDeepest) fail("more links hang one below the other", kDeepest);
    }
    std::size_t moving = 0;
    for (const robot::Joint& joint : arm_.joints) moving += joint.coordinate >= 0;
    if (moving > robot::kMaxRows) {
      fail(std::to_string(moving) + " joints move, with those that mimic others", robot::kMaxRows);
    }
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
        Fail(tree_.FindJoint(name)->line, "joint '" + name + "'",
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

  // Of the shape of its hulls, and of boxes around other solids.
  bool GiveWeight(const std::vector<int>& links) {
    for (const int number : links) {
      robot::ArmLink& link = arm_.links[static_cast<std::size_t>(number) + 1];
      if (link.solids.empty()) continue;
      Eigen::AlignedBox3d box;
      double volume_m3 = 0;
      for (const robot::LinkSolid& solid : link.solids) {
        const auto* const hull = std::get_if<robot::HullSolid>(&solid.form);
        Eigen::Vector3d low, high;
        if (hull != nullptr) {
          low = hull->vertices.rowwise().minCoeff();
          high = hull->vertices.rowwise().maxCoeff();
          volume_m3 += SignedVolume_m3({hull->vertices, hull->triangles});
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
    if (!tree_.only_drawn.empty()) {
      Note("drawn, but able to touch nothing (--visuals-as-collisions takes what is drawn): " +
           Joined(tree_.only_drawn));
    }
    if (!weightless_.empty()) {
      Note("weigh nothing, but for what is fixed to them: " + Joined(weightless_));
    }
    if (!unlimited_.empty()) Note("have no limit of torque: " + Joined(unlimited_));
    if (!held_.empty()) Note("held: " + Joined(held_));
    if (!choices_.ramp_s) {
      Note(
          "no limits of acceleration and jerk are known, and none are written "
          "(--ramp-s derives some)");
    }
    imported_.arm = std::move(arm_);
  }

  const robot::RobotTree& tree_;
  const ArmChoices& choices_;
  const JointChoice choice_;
  robot::ArmDescription arm_;
  ImportedArm imported_;
  std::map<std::string, int> coordinates_;  // of joints that move
  std::set<std::string> renamed_;
  std::vector<std::string> held_, weightless_, unlimited_;
};

}  // namespace

ImportedArm ArmOfTree(const robot::RobotTree& tree, const ArmChoices& choices) {
  return Maker(tree, choices).Make();
}

}  // namespace sidestep::imports
