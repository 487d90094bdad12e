#include "sidestep/import/urdf_tree.h"

#include <optional>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/import/inertia.h"
#include "sidestep/import/solid_reader.h"
#include "sidestep/import/urdf_file.h"
#include "sidestep/import/urdf_pose.h"

namespace sidestep::imports {
namespace {

class TreeReader {
 public:
  TreeReader(const UrdfFile& file, const ArmChoices& choices) : file_(file), choices_(choices) {}

  robot::RobotTree Read() {
    tree_.file = file_.path;
    tree_.root = file_.model->getRoot()->name;
    tree_.notes = file_.notes;
    for (const std::string& name : file_.joint_order) AddJoint(*file_.model->joints_.at(name));
    const bool is_part = file_.model->links_.count(choices_.base) > 0;
    const std::string base = is_part ? choices_.base : tree_.root;
    for (const auto& [name, link] : file_.model->links_) {
      if (IsBelow(name, base)) {
        AddLink(*link);
      } else {
        tree_.links.push_back({{name, std::nullopt, {}}, file_.LineOf("link " + name)});
      }
    }
    return std::move(tree_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what, const std::string& key,
                         const std::string& why) const {
    throw InputError(file_.path, file_.LineOf(what), key, why);
  }

  bool IsBelow(std::string link, const std::string& base) const {
    while (link != base) {
      const urdf::JointSharedPtr joint = file_.model->links_.at(link)->parent_joint;
      if (joint == nullptr) return false;
      link = joint->parent_link_name;
    }
    return true;
  }

  void AddLink(const urdf::Link& from) {
    robot::TreeLink link;
    link.line = file_.LineOf("link " + from.name);
    link.link.name = from.name;
    if (from.inertial != nullptr) link.link.inertia = InertiaOf(from);
    link.link.solids = ReadSolids(file_, from, choices_, &tree_.notes);
    if (link.link.solids.empty() && !from.visual_array.empty()) {
      tree_.only_drawn.push_back(from.name);
    }
    tree_.links.push_back(std::move(link));
  }

  std::optional<robot::LinkInertia> InertiaOf(const urdf::Link& link) {
    const urdf::Inertial& from = *link.inertial;
    const std::string key = "link '" + link.name + "'", what = "inertial " + link.name;
    if (from.mass == 0) return std::nullopt;  // as frames are often written
    if (!(from.mass > 0)) Fail(what, key + ": mass", "must be > 0, is " + ShortestText(from.mass));
    const Pose X_LI = PoseOf(from.origin);
    Eigen::Matrix3d I;
    I << from.ixx, from.ixy, from.ixz, from.ixy, from.iyy, from.iyz, from.ixz, from.iyz, from.izz;
    if (const std::string why = WhyNoInertia(I); !why.empty()) {
      if (!choices_.repair_inertia) {
        Fail(what, key + ": inertia", why + " (--repair-inertia mends that)");
      }
      I = RepairedInertia(I);
      tree_.notes.push_back(key + ": its inertia " + why + "; mended to " + ShortestText(I(0, 0)) +
                            ", " + ShortestText(I(1, 1)) + ", " + ShortestText(I(2, 2)) +
                            " about its own axes");
    }
    const Eigen::Matrix3d R = X_LI.rotation().toRotationMatrix();
    return robot::LinkInertia{from.mass, X_LI.translation(), R * I * R.transpose()};
  }

  void AddJoint(const urdf::Joint& from) {
    robot::TreeJoint joint;
    const std::string what = "joint " + from.name, key = "joint '" + from.name + "': ";
    joint.line = file_.LineOf(what);
    joint.name = from.name;
    joint.parent = from.parent_link_name;
    joint.child = from.child_link_name;
    joint.X_PJ = PoseOf(from.parent_to_joint_origin_transform);
    if (from.type == urdf::Joint::FIXED) {
      tree_.joints.push_back(joint);
      return;
    }
    joint.kind = from.type == urdf::Joint::PRISMATIC ? robot::JointKind::kPrismatic
                                                     : robot::JointKind::kRevolute;
    joint.axis_J = Eigen::Vector3d(from.axis.x, from.axis.y, from.axis.z).normalized();
    if (from.limits != nullptr) {
      if (from.type != urdf::Joint::CONTINUOUS) {
        joint.q_min = from.limits->lower;
        joint.q_max = from.limits->upper;
      }
      if (from.limits->velocity < 0) Fail(what, key + "limit", "velocity must not be negative");
      if (from.limits->effort < 0) Fail(what, key + "limit", "effort must not be negative");
      if (from.limits->velocity > 0) joint.v_max = from.limits->velocity;  // 0: not known
      if (from.limits->effort > 0) joint.torque_max = from.limits->effort;
    }
    if (from.dynamics != nullptr) {
      if (from.dynamics->damping < 0 || from.dynamics->friction < 0) {
        Fail(what, key + "dynamics", "must be >= 0");
      }
      joint.dynamics.damping = from.dynamics->damping;
      joint.dynamics.friction = from.dynamics->friction;
    }
    if (from.mimic != nullptr) {
      joint.mimic = {from.mimic->joint_name, from.mimic->multiplier, from.mimic->offset};
    }
    tree_.joints.push_back(joint);
  }

  const UrdfFile& file_;
  const ArmChoices& choices_;
  robot::RobotTree tree_;
};

}  // namespace

robot::RobotTree ReadUrdfTree(const std::string& path, const ArmChoices& choices) {
  const UrdfFile file = ReadUrdf(path);
  return TreeReader(file, choices).Read();
}

}  // namespace sidestep::imports
