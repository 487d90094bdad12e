#pragma once

#include <urdf_model/pose.h>

#include "sidestep/core/pose.h"

namespace sidestep::imports {

inline Pose PoseOf(const urdf::Pose& pose) {
  const urdf::Rotation& R = pose.rotation;
  return Pose(Eigen::Quaterniond(R.w, R.x, R.y, R.z),
              Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z));
}

}  // namespace sidestep::imports
