#pragma once

#include <Eigen/Core>

namespace sidestep::imports {

/// A sphere in the frame of a link.
struct CoverSphere {
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

}  // namespace sidestep::imports
