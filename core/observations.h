#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/shape.h"
#include "sidestep/core/time.h"

namespace sidestep {

/// One named object, as a tag camera (or the simulator itself) reports it.
struct ObjectObservation {
  std::string id;
  EpisodeTime t;
  Pose X_WO;
  /// Of position (x, y, z in W) and rotation vector, m and rad; zero when exact.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Shape shape;
};

/// What the points of a scan are.
enum class ScanKind {
  kSolid,    ///< throughout the solids, everywhere: a cell without a point is free
  kSurface,  ///< where the sensor's rays end: what is behind a point, or on no ray, is not seen
};

/// The solid world as a sensor saw it at one moment, as points, named objects or both.
struct Scan {
  EpisodeTime t;       ///< when it was captured, not when it arrived
  std::string sensor;  ///< its name
  ScanKind kind = ScanKind::kSolid;
  Pose X_WC;              ///< where the sensor stood
  Eigen::Matrix3Xd p_CP;  ///< [m] the points, in the sensor's frame
  /// kSurface only: which ray of the sensor each of these points ends, from 0; a ray points the
  /// same way in all of its scans. Empty: that is not known.
  std::vector<int> rays;
  Eigen::Matrix3Xd p_CFree;                ///< [m] kSurface only: ends of rays that met nothing
  std::vector<ObjectObservation> objects;  ///< whose solids the points leave out
};

}  // namespace sidestep
