#include "sidestep/import/surface_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sidestep::imports {

void PointThinner::Add(const Eigen::Vector3d& p) {
  std::array<std::int64_t, 3> cube;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cube[axis] =
        static_cast<std::int64_t>(std::floor(p[static_cast<Eigen::Index>(axis)] / cube_m_));
  }
  if (taken_.insert(cube).second) points_.push_back(p);
}

Eigen::Matrix3Xd PointThinner::Points() const {
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(points_.size()));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points.col(static_cast<Eigen::Index>(i)) = points_[i];
  }
  return points;
}

Eigen::Matrix3Xd SurfacePoints(const std::vector<TriangleMesh>& meshes, double apart_m) {
  PointThinner thinner(apart_m);
  for (const TriangleMesh& mesh : meshes) {
    for (const auto& p : mesh.vertices.colwise()) thinner.Add(p);
  }
  for (const TriangleMesh& mesh : meshes) {
    for (const auto& triangle : mesh.triangles.colwise()) {
      const Eigen::Vector3d a = mesh.vertices.col(triangle[0]);
      const Eigen::Vector3d ab = mesh.vertices.col(triangle[1]) - a;
      const Eigen::Vector3d ac = mesh.vertices.col(triangle[2]) - a;
      const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
      const int n = static_cast<int>(std::ceil(longest / apart_m));
      for (int i = 0; i <= n; ++i) {
        for (int k = 0; i + k <= n; ++k) thinner.Add(a + ab * i / n + ac * k / n);
      }
    }
  }
  return thinner.Points();
}

double Area_m2(const std::vector<TriangleMesh>& meshes) {
  double area = 0;
  for (const TriangleMesh& mesh : meshes) {
    for (const auto& triangle : mesh.triangles.colwise()) {
      const Eigen::Vector3d a = mesh.vertices.col(triangle[0]);
      area +=
          (mesh.vertices.col(triangle[1]) - a).cross(mesh.vertices.col(triangle[2]) - a).norm() / 2;
    }
  }
  return area;
}

}  // namespace sidestep::imports
