#include "sidestep/robot/robot_model.h"

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>

namespace sidestep::robot {

int RobotModel::LineOf(const std::string& key) const {
  const auto found = lines_.find(key);
  return found == lines_.end() ? 1 : found->second;
}

RowPlaces RobotModel::PlacesAt(const Eigen::VectorXd& q) const {
  if (q.size() != num_joints()) {
    throw std::invalid_argument("RobotModel: q must have " + std::to_string(num_joints()) +
                                " values, has " + std::to_string(q.size()));
  }
  RowPlaces places;
  places.of[0].R_WK = X_WB_.rotation().toRotationMatrix();
  places.of[0].p_WK = X_WB_.translation();
  PlaceRows(kinematics_.rows(), q, places);
  return places;
}

Pose RobotModel::PoseOf(int link, const RowPlaces& places) const {
  const LinkOnRow& on = kinematics_.link(link);
  const RowPlace& row = places[on.row];
  return Pose(Eigen::Quaterniond(on.is_moved ? Eigen::Matrix3d(row.R_WK * on.R_KL) : row.R_WK),
              on.is_moved ? Eigen::Vector3d(row.p_WK + row.R_WK * on.p_KL) : row.p_WK);
}

std::vector<Pose> RobotModel::ComputeLinkPoses(const Eigen::VectorXd& q) const {
  const RowPlaces places = PlacesAt(q);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    poses.push_back(PoseOf(static_cast<int>(i), places));
  }
  return poses;
}

Pose RobotModel::ComputeToolPose(const Eigen::VectorXd& q) const {
  const RowPlaces places = PlacesAt(q);
  const Pose X_WL = PoseOf(tool_link_, places);
  return X_LTool_ ? X_WL * *X_LTool_ : X_WL;
}

SphereCenters RobotModel::ComputeSphereCenters(const Eigen::VectorXd& q, bool with_jacobian) const {
  const RowPlaces places = PlacesAt(q);
  SphereCenters result;
  result.p_WS.resize(3, num_spheres());
  if (with_jacobian) result.Jq.setZero(3 * num_spheres(), num_joints());
  for (int s = 0; s < num_spheres(); ++s) {
    const CollisionSphere& sphere = spheres_[static_cast<std::size_t>(s)];
    const LinkOnRow& link = kinematics_.link(sphere.link);
    const RowPlace& place = places[link.row];
    const Eigen::Vector3d p_WS = place.p_WK + place.R_WK * link.OnRow(sphere.p_LS);
    result.p_WS.col(s) = p_WS;
    if (!with_jacobian) continue;
    for (const int mover : kinematics_.movers(link.row)) {
      const KinematicRow& row = kinematics_.rows()[static_cast<std::size_t>(mover)];
      const RowPlace& at = places[mover];
      const Eigen::Vector3d p_JS_W = p_WS - at.p_WJ;
      const Eigen::Vector3d slope = row.slides ? at.z_W : Eigen::Vector3d(at.z_W.cross(p_JS_W));
      result.Jq.block<3, 1>(3 * s, row.coordinate) += row.multiplier * slope;
    }
  }
  return result;
}

}  // namespace sidestep::robot
