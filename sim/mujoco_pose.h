#pragma once

#include <mujoco/mujoco.h>

#include "sidestep/core/pose.h"

namespace sidestep::sim {

/// R_WG of a geom, as MuJoCo last computed it.
inline Eigen::Matrix3d GeomRotation(const mjData& data, int geom) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * geom);
}

/// p_WG of a geom's centre [m], as MuJoCo last computed it.
inline Eigen::Vector3d GeomPosition(const mjData& data, int geom) {
  return Eigen::Map<const Eigen::Vector3d>(data.geom_xpos + 3 * geom);
}

inline Pose GeomPose(const mjData& data, int geom) {
  return Pose(Eigen::Quaterniond(GeomRotation(data, geom)), GeomPosition(data, geom));
}

}  // namespace sidestep::sim
