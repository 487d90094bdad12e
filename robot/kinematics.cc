#include "sidestep/robot/kinematics.h"

#include <Eigen/Geometry>

namespace sidestep::robot {
namespace {

// The least turn that lays z along the axis; none for z itself.
Eigen::Matrix3d TurnOfZ(const Eigen::Vector3d& axis) {
  if (axis == Eigen::Vector3d::UnitZ()) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
}

}  // namespace

Kinematics::Kinematics(const std::vector<Joint>& joints) {
  links_.emplace_back();
  movers_.emplace_back();
  for (const Joint& joint : joints) {
    // Where the joint's frame is in that of the row that carries it.
    const int parent_link = joint.parent + 1;
    const LinkOnRow& parent = links_[static_cast<std::size_t>(parent_link)];
    LinkOnRow at = parent;
    const Eigen::Matrix3d R_PJ = joint.X_PJ.rotation().toRotationMatrix();
    if (!R_PJ.isIdentity(0) || !joint.X_PJ.translation().isZero(0)) {
      at.p_KL = parent.OnRow(joint.X_PJ.translation());
      at.R_KL = parent.R_KL * R_PJ;
      at.is_moved = true;
    }
    if (joint.kind == JointKind::kFixed) {
      links_.push_back(at);
      continue;
    }

    const Eigen::Matrix3d R_JA = joint.dh ? Eigen::Matrix3d::Identity() : TurnOfZ(joint.axis_J);
    KinematicRow& row = rows_.emplace_back();
    row.parent = at.row;
    row.R_PA = at.R_KL * R_JA;
    row.p_PA = at.p_KL;
    row.is_moved = at.is_moved || !R_JA.isIdentity(0);
    row.slides = joint.kind == JointKind::kPrismatic;
    row.coordinate = joint.coordinate;
    row.multiplier = joint.multiplier;
    row.offset = joint.offset;
    if (joint.dh) {
      row.theta_rad = joint.dh->theta_rad;
      row.d_m = joint.dh->d_m;
      row.a_m = joint.dh->a_m;
      row.cos_alpha = std::cos(joint.dh->alpha_rad);
      row.sin_alpha = std::sin(joint.dh->alpha_rad);
    }

    LinkOnRow& link = links_.emplace_back();
    link.row = static_cast<int>(rows_.size()) - 1;
    link.R_KL = R_JA.transpose();
    link.is_moved = !R_JA.isIdentity(0);
    movers_.push_back(movers(row.parent));
    movers_.back().push_back(link.row);
  }
}

}  // namespace sidestep::robot
