#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/markup.h"
#include "sidestep/core/number_text.h"
#include "sidestep/import/arm_pose.h"
#include "sidestep/import/robot_files.h"

namespace sidestep::imports {
namespace {

std::string Numbers(const Eigen::VectorXd& values) { return Joined(values, " ", &ShortestNumber); }

// In a comment two dashes are not allowed.
std::string InComment(std::string text) {
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;) text[at] = ' ';
  return text;
}

// With the rotation that robot.yaml says, to the last bit.
std::string PlaceText(const Pose& X) {
  const Eigen::Vector3d rpy = RollPitchYawOf(X.rotation().toRotationMatrix());
  std::string text;
  if (!X.translation().isZero(0)) text += " pos=\"" + Numbers(X.translation()) + "\"";
  if (!rpy.isZero(0)) {
    const Eigen::Quaterniond q = Pose::FromRollPitchYaw(rpy, Eigen::Vector3d::Zero()).rotation();
    text += " quat=\"" + Numbers(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z())) + "\"";
  }
  return text;
}

std::string MeshName(const robot::ArmLink& link, std::size_t solid) {
  return EscapeMarkup(link.name) + "/" + std::to_string(solid);
}

struct SizeText {
  std::string operator()(const Box& box) const { return Numbers(box.size_m / 2); }
  std::string operator()(const Sphere& sphere) const { return ShortestNumber(sphere.radius_m); }
  std::string operator()(const Capsule& capsule) const {
    return Numbers(Eigen::Vector2d(capsule.radius_m, capsule.length_m / 2));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return Numbers(Eigen::Vector2d(cylinder.radius_m, cylinder.length_m / 2));
  }
  std::string operator()(const Ellipsoid& ellipsoid) const {
    return Numbers(ellipsoid.semi_axes_m);
  }
  std::string operator()(const ConvexMesh&) const { return ""; }  // its vertices say it
};

// The corners of a solid that is written as a mesh.
std::optional<Eigen::Matrix3Xd> CornersOf(const robot::LinkSolid& solid) {
  if (const auto* const hull = std::get_if<robot::HullSolid>(&solid.form)) return hull->vertices;
  const auto* const mesh = std::get_if<ConvexMesh>(&std::get<Shape>(solid.form));
  if (mesh == nullptr) return std::nullopt;
  const std::vector<Eigen::Vector3d>& vertices = mesh->hull->vertices();
  Eigen::Matrix3Xd corners(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    corners.col(static_cast<Eigen::Index>(i)) = vertices[i];
  }
  return corners;
}

class MjcfWriter {
 public:
  explicit MjcfWriter(const robot::ArmDescription& arm) : arm_(arm) {}

  std::string Write(const LinkPairs& without_contact) {
    text_ = "<!-- " + InComment(arm_.name) + ", made of " + InComment(arm_.source) +
            " by sidestep import, which has all figures\n     that have no other source beside "
            "them. Its licence is that of what it was made of. -->\n";
    Line(0, "<mujoco model=\"" + EscapeMarkup(arm_.name) + "\">");
    Line(1, "<compiler angle=\"radian\" inertiafromgeom=\"false\"/>");
    Line(1, "<default>");
    Line(2, "<geom group=\"1\" rgba=\"0.75 0.77 0.8 1\"/>");
    Line(1, "</default>");
    WriteMeshes();
    Line(1, "<worldbody>");
    WriteBody(-1, 2);
    Line(1, "</worldbody>");
    WriteContact(without_contact);
    WriteMimics();
    WriteMotors();
    Line(0, "</mujoco>");
    return text_;
  }

 private:
  void Line(int depth, const std::string& line) {
    text_ += std::string(static_cast<std::size_t>(2 * depth), ' ') + line + "\n";
  }

  void WriteMeshes() {
    bool has_meshes = false;
    for (const robot::ArmLink& link : arm_.links) {
      for (std::size_t i = 0; i < link.solids.size(); ++i) {
        const std::optional<Eigen::Matrix3Xd> corners = CornersOf(link.solids[i]);
        if (!corners) continue;
        if (!has_meshes) Line(1, "<asset>");
        has_meshes = true;
        if (!link.solids[i].source.empty()) {
          Line(2, "<!-- the convex hull of " + InComment(link.solids[i].source) + " -->");
        }
        Line(2, "<mesh name=\"" + MeshName(link, i) + "\" vertex=\"" +
                    Numbers(corners->reshaped()) + "\"/>");
      }
    }
    if (has_meshes) Line(1, "</asset>");
  }

  void WriteBody(int number, int depth) {
    const robot::ArmLink& link = arm_.LinkOf(number);
    std::string place;
    if (number >= 0) place = PlaceText(arm_.joints[static_cast<std::size_t>(number)].X_PJ);
    Line(depth, "<body name=\"" + EscapeMarkup(link.name) + "\"" + place + ">");
    if (link.inertia) {
      const Eigen::Matrix3d& I = link.inertia->I_C;
      Eigen::Matrix<double, 6, 1> parts;
      parts << I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2);
      Line(depth + 1, "<inertial mass=\"" + ShortestNumber(link.inertia->mass_kg) + "\" pos=\"" +
                          Numbers(link.inertia->p_LC) + "\" fullinertia=\"" + Numbers(parts) +
                          "\"/>");
    }
    if (number >= 0) WriteJoint(static_cast<std::size_t>(number), depth + 1);
    for (std::size_t i = 0; i < link.solids.size(); ++i) WriteGeom(link, i, depth + 1);
    for (std::size_t i = 0; i < arm_.joints.size(); ++i) {
      if (arm_.joints[i].parent == number) WriteBody(static_cast<int>(i), depth + 1);
    }
    Line(depth, "</body>");
  }

  void WriteJoint(std::size_t i, int depth) {
    const robot::Joint& joint = arm_.joints[i];
    if (joint.kind == robot::JointKind::kFixed) return;
    std::string line = "<joint name=\"" + EscapeMarkup(joint.name) + "\"";
    if (joint.kind == robot::JointKind::kPrismatic) line += " type=\"slide\"";
    line += " axis=\"" + Numbers(joint.axis_J) + "\"";
    if (!IsMimic(i)) {
      const robot::JointLimits& limits = arm_.limits[static_cast<std::size_t>(joint.coordinate)];
      if (std::isfinite(limits.q_min) && std::isfinite(limits.q_max)) {
        line += " limited=\"true\" range=\"" + ShortestNumber(limits.q_min) + " " +
                ShortestNumber(limits.q_max) + "\"";
      }
    }
    const robot::JointDynamics& dynamics = arm_.dynamics[i];
    if (dynamics.damping > 0) line += " damping=\"" + ShortestNumber(dynamics.damping) + "\"";
    if (dynamics.friction > 0)
      line += " frictionloss=\"" + ShortestNumber(dynamics.friction) + "\"";
    if (dynamics.armature > 0) line += " armature=\"" + ShortestNumber(dynamics.armature) + "\"";
    Line(depth, line + "/>");
  }

  void WriteGeom(const robot::ArmLink& link, std::size_t i, int depth) {
    const robot::LinkSolid& solid = link.solids[i];
    std::string form;
    if (CornersOf(solid)) {
      form = "type=\"mesh\" mesh=\"" + MeshName(link, i) + "\"";
    } else {
      const Shape& shape = std::get<Shape>(solid.form);
      form = "type=\"" + ShapeName(shape) + "\" size=\"" + std::visit(SizeText{}, shape) + "\"";
    }
    Line(depth, "<geom " + form + PlaceText(solid.X_LS) + "/>");
  }

  void WriteContact(const LinkPairs& without_contact) {
    if (without_contact.empty()) return;
    Line(1, "<contact>");
    for (const robot::LinkPair& pair : without_contact) {
      Line(2, "<exclude body1=\"" + EscapeMarkup(arm_.LinkOf(pair.first).name) + "\" body2=\"" +
                  EscapeMarkup(arm_.LinkOf(pair.second).name) + "\"/>");
    }
    Line(1, "</contact>");
  }

  // A joint that mimics comes after the one that it mimics, which has the same coordinate.
  std::size_t LeaderOf(std::size_t i) const {
    const auto leads = [&](const robot::Joint& other) {
      return other.coordinate == arm_.joints[i].coordinate;
    };
    return static_cast<std::size_t>(std::find_if(arm_.joints.begin(), arm_.joints.end(), leads) -
                                    arm_.joints.begin());
  }
  bool IsMimic(std::size_t i) const { return arm_.joints[i].coordinate >= 0 && LeaderOf(i) != i; }

  void WriteMimics() {
    bool is_first = true;
    for (std::size_t i = 0; i < arm_.joints.size(); ++i) {
      if (!IsMimic(i)) continue;
      if (is_first) Line(1, "<equality>");
      is_first = false;
      const robot::Joint& joint = arm_.joints[i];
      Line(2, "<joint joint1=\"" + EscapeMarkup(joint.name) + "\" joint2=\"" +
                  EscapeMarkup(arm_.joints[LeaderOf(i)].name) + "\" polycoef=\"" +
                  ShortestNumber(joint.offset) + " " + ShortestNumber(joint.multiplier) +
                  " 0 0 0\" solref=\"0.005 1\"/>");
    }
    if (!is_first) Line(1, "</equality>");
  }

  void WriteMotors() {
    Line(1, "<actuator>");
    for (std::size_t i = 0; i < arm_.joints.size(); ++i) {
      const robot::Joint& joint = arm_.joints[i];
      if (joint.coordinate < 0 || IsMimic(i)) continue;
      std::string line = "<motor name=\"" + EscapeMarkup(joint.name) + "\" joint=\"" +
                         EscapeMarkup(joint.name) + "\"";
      const double most = arm_.limits[static_cast<std::size_t>(joint.coordinate)].torque_max;
      if (std::isfinite(most)) {
        line += " ctrllimited=\"true\" ctrlrange=\"" + ShortestNumber(-most) + " " +
                ShortestNumber(most) + "\"";
      }
      Line(2, line + "/>");
    }
    Line(1, "</actuator>");
  }

  const robot::ArmDescription& arm_;
  std::string text_;
};

// Of each link (entry 0: the base) the first link of those that are fixed together with it.
std::vector<int> RigidBodies(const robot::ArmDescription& arm) {
  std::vector<int> bodies = {-1};
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const robot::Joint& joint = arm.joints[i];
    const int parent_entry = joint.parent + 1;
    bodies.push_back(joint.kind == robot::JointKind::kFixed
                         ? bodies[static_cast<std::size_t>(parent_entry)]
                         : static_cast<int>(i));
  }
  return bodies;
}

}  // namespace

std::vector<int> FixedLinks(const robot::ArmDescription& arm) {
  const std::vector<int> bodies = RigidBodies(arm);
  std::vector<int> fixed;
  for (std::size_t entry = 0; entry < bodies.size(); ++entry) {
    if (bodies[entry] < 0) fixed.push_back(static_cast<int>(entry) - 1);
  }
  return fixed;
}

LinkPairs PairsWithoutContact(const robot::ArmDescription& arm, const LinkPairs& always) {
  const std::vector<int> bodies = RigidBodies(arm);
  LinkPairs pairs;
  for (const int fixed : FixedLinks(arm)) {
    if (arm.LinkOf(fixed).solids.empty()) continue;
    for (std::size_t i = 0; i < arm.joints.size(); ++i) {
      const int link = static_cast<int>(i);
      const int body = bodies[i + 1];
      if (body < 0 || arm.LinkOf(link).solids.empty()) continue;
      const int parent_entry = arm.joints[static_cast<std::size_t>(body)].parent + 1;
      if (bodies[static_cast<std::size_t>(parent_entry)] >= 0) continue;
      pairs.push_back({std::min(fixed, link), std::max(fixed, link)});
    }
  }
  const auto is_there = [&pairs](const robot::LinkPair& pair) {
    return std::any_of(pairs.begin(), pairs.end(), [&pair](const robot::LinkPair& other) {
      return other.first == pair.first && other.second == pair.second;
    });
  };
  for (const LinkPairs& others : {arm.without_contact, always}) {
    for (const robot::LinkPair& pair : others) {
      if (!is_there(pair)) pairs.push_back(pair);
    }
  }
  return pairs;
}

std::string MjcfText(const robot::ArmDescription& arm, const LinkPairs& without_contact) {
  return MjcfWriter(arm).Write(without_contact);
}

}  // namespace sidestep::imports
