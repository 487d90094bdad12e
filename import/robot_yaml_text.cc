#include <algorithm>
#include <cmath>

#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/import/arm_pose.h"
#include "sidestep/import/robot_files.h"
#include "sidestep/robot/limit_keys.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::imports {
namespace {

using scenarios::Quoted;

std::string List(const Eigen::VectorXd& values) {
  return "[" + Joined(values, ", ", &ShortestNumber) + "]";
}

// A coordinate to a tenth of a micrometre.
Eigen::VectorXd RoundedCoordinates(const Eigen::VectorXd& values) {
  return (values * 1e7).array().round().matrix() / 1e7;
}

class RobotYamlWriter {
 public:
  RobotYamlWriter(const robot::ArmDescription& arm, const RobotDetails& details)
      : arm_(arm), details_(details) {}

  std::string Write() {
    text_ = "# " + OneLine(arm_.name) + ", made of " + OneLine(arm_.source) +
            " by sidestep import: joints, limits and frames\n"
            "# are as written there; what was derived says so. Keys: docs/robots.md.\n";
    Line("name: " + Quoted(arm_.name));
    Line("base: " + Quoted(arm_.LinkOf(-1).name));
    Line("");
    Line("joints:");
    for (std::size_t i = 0; i < arm_.joints.size(); ++i) WriteJoint(i);
    Line("");
    WriteSpheres();
    Line("# Found free of self-contact.");
    Line("configurations:");
    Line("  home: " + List(details_.home));
    Line("tool_frame: {link: " + Quoted(arm_.tool_link) + "}");
    WriteMount();
    WriteCapsules();
    WriteSelfCollision();
    WriteControl();
    return text_;
  }

 private:
  static std::string OneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  }
  void Line(const std::string& line) { text_ += line + "\n"; }
  std::string LinkName(int link) const { return Quoted(arm_.LinkOf(link).name); }

  void WriteJoint(std::size_t i) {
    const robot::Joint& joint = arm_.joints[i];
    Line("  - name: " + Quoted(joint.name));
    if (joint.kind == robot::JointKind::kFixed) Line("    kind: fixed");
    if (joint.kind == robot::JointKind::kPrismatic) Line("    kind: prismatic");
    Line("    link: " + Quoted(joint.link));
    Line("    parent: " + LinkName(joint.parent));
    const Eigen::Vector3d rpy = RollPitchYawOf(joint.X_PJ.rotation().toRotationMatrix());
    Line("    origin: {position_m: " + List(joint.X_PJ.translation()) +
         (rpy.isZero(0) ? "" : ", rpy_rad: " + List(rpy)) + "}");
    if (joint.kind == robot::JointKind::kFixed) return;
    Line("    axis: " + List(joint.axis_J));
    const auto leader =
        static_cast<std::size_t>(std::find_if(arm_.joints.begin(), arm_.joints.end(),
                                              [&](const robot::Joint& other) {
                                                return other.coordinate == joint.coordinate;
                                              }) -
                                 arm_.joints.begin());
    if (leader != i) {
      Line("    mimic: {joint: " + Quoted(arm_.joints[leader].name) +
           ", multiplier: " + ShortestNumber(joint.multiplier) +
           (joint.kind == robot::JointKind::kPrismatic ? ", offset_m: " : ", offset_rad: ") +
           ShortestNumber(joint.offset) + "}");
      return;
    }
    WriteLimits(arm_.limits[static_cast<std::size_t>(joint.coordinate)],
                robot::LimitKeysOf(joint.kind));
  }

  void WriteLimits(const robot::JointLimits& limits, const robot::LimitKeys& keys) {
    std::string line;
    const auto add = [&line](const char* key, double value) {
      if (!std::isfinite(value)) return;
      line += (line.empty() ? "" : ", ") + std::string(key) + ": " + ShortestNumber(value);
    };
    add(keys.q_min, limits.q_min);
    add(keys.q_max, limits.q_max);
    add(keys.v_max, limits.v_max);
    add(keys.a_max, limits.a_max);
    add(keys.jerk_max, limits.jerk_max);
    add(keys.torque_max, limits.torque_max);
    add(keys.torque_rate_max, limits.torque_rate_max);
    Line("    limits: {" + line + "}");
  }

  void WriteSpheres() {
    Line("# They hold all that can touch.");
    Line("spheres:");
    for (const robot::CollisionSphere& sphere : details_.spheres) {
      Line("  - {link: " + LinkName(sphere.link) +
           ", center_m: " + List(RoundedCoordinates(sphere.p_LS)) +
           ", radius_m: " + ShortestNumber(std::ceil(sphere.radius_m * 1e5) / 1e5) + "}");
    }
  }

  void WriteMount() {
    std::string links;
    for (const int link : FixedLinks(arm_)) {
      if (link < 0 || !arm_.LinkOf(link).solids.empty()) {
        links += (links.empty() ? "" : ", ") + LinkName(link);
      }
    }
    Line("# What never moves, and what always reaches down to where the base stands.");
    Line("mount: {spheres: [" +
         Joined(details_.mount_spheres, ", ", [](int i) { return std::to_string(i); }) +
         "], links: [" + links + "]}");
  }

  void WriteCapsules() {
    if (details_.capsules.empty()) return;
    Line("# One around all of a link that can touch.");
    Line("capsules:");
    for (const robot::CollisionCapsule& capsule : details_.capsules) {
      Line("  - {link: " + LinkName(capsule.link) +
           ", from_m: " + List(RoundedCoordinates(capsule.p_LA)) +
           ", to_m: " + List(RoundedCoordinates(capsule.p_LB)) +
           ", radius_m: " + ShortestNumber(std::ceil(capsule.radius_m * 1e5) / 1e5) + "}");
    }
  }

  void WriteSelfCollision() {
    if (details_.self_collision.empty()) return;
    Line("# Links that touch each other at some of the configurations that were tried.");
    Line("self_collision:");
    for (const robot::LinkPair& pair : details_.self_collision) {
      Line("  - {links: [" + LinkName(pair.first) + ", " + LinkName(pair.second) + "]}");
    }
  }

  void WriteControl() {
    Line("# To start from: critically damped at " + ShortestNumber(details_.bandwidth_rad_s) +
         " rad/s by the greatest inertia that each joint was");
    Line(
        "# seen to move alone, with the armature of the MJCF (an assumption, for nothing is known "
        "of");
    Line("# motors); stable with a command every millisecond.");
    Line("control:");
    Line("  stiffness_n_m_rad: " + List(details_.stiffness));
    Line("  damping_n_m_s_rad: " + List(details_.damping));
  }

  const robot::ArmDescription& arm_;
  const RobotDetails& details_;
  std::string text_;
};

}  // namespace

std::string RobotYamlText(const robot::ArmDescription& arm, const RobotDetails& details) {
  return RobotYamlWriter(arm, details).Write();
}

}  // namespace sidestep::imports
