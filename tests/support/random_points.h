#pragma once

#include <Eigen/Geometry>

#include "sidestep/core/pose.h"
#include "sidestep/core/random.h"

namespace sidestep {

/// A point whose coordinates are within `reach` of 0.
inline Eigen::Vector3d UniformPoint(RandomStream& random, double reach) {
  // In braces the first is drawn first, whatever the compiler.
  return Eigen::Vector3d{random.Uniform(-reach, reach), random.Uniform(-reach, reach),
                         random.Uniform(-reach, reach)};
}

/// Such points, one column each.
inline Eigen::Matrix3Xd UniformPoints(RandomStream& random, int count, double reach) {
  Eigen::Matrix3Xd points(3, count);
  for (auto point : points.colwise()) point = UniformPoint(random, reach);
  return points;
}

/// Turned any way, at a point whose coordinates are within `reach_m` of 0.
inline Pose RandomPose(RandomStream& random, double reach_m) {
  const Eigen::Vector4d xyzw{random.Normal(), random.Normal(), random.Normal(), random.Normal()};
  return Pose(Eigen::Quaterniond(xyzw), UniformPoint(random, reach_m));
}

}  // namespace sidestep
