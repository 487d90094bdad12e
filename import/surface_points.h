#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {

/// Of the points that it is given, keeps the first one in each cube of a grid.
class PointThinner {
 public:
  explicit PointThinner(double cube_m) : cube_m_(cube_m) {}

  void Add(const Eigen::Vector3d& p);
  Eigen::Matrix3Xd Points() const;  ///< in the order in which they came

 private:
  double cube_m_;
  std::set<std::array<std::int64_t, 3>> taken_;
  std::vector<Eigen::Vector3d> points_;
};

/// Points all over the surface of meshes, one in each cube of edge `apart_m` that it leads through,
/// or nearly: corners of the meshes before others. Shape 3 x N.
Eigen::Matrix3Xd SurfacePoints(const std::vector<TriangleMesh>& meshes, double apart_m);

/// The area of the surface of meshes [m^2].
double Area_m2(const std::vector<TriangleMesh>& meshes);

}  // namespace sidestep::imports
