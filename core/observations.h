#pragma once

#include <Eigen/Core>
#include <string>

#include "core/pose.h"
#include "core/shape.h"
#include "core/time.h"

namespace sidestep {

/// Points on or in the solid world, as a sensor saw them at one moment: a camera's surface points,
/// or the centres of filled cells.
struct Scan {
  EpisodeTime t;          ///< when it was captured, not when it arrived
  Pose X_WC;              ///< where the sensor stood
  Eigen::Matrix3Xd p_CP;  ///< [m] the points, in the sensor's frame
};

/// One named object, as a tag camera (or the simulator itself) reports it.
struct ObjectObservation {
  std::string id;
  EpisodeTime t;
  Pose X_WO;
  /// Of position (x, y, z in W) and rotation vector, m and rad; zero when exact.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Shape shape;
};

}  // namespace sidestep
