#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sidestep/core/random.h"
#include "sidestep/import/outer_mesh.h"
#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {

/// A closed mesh with dents and bumps: a ball whose radius varies with the direction, by at most
/// `bumps` of itself.
inline TriangleMesh BumpyBall(RandomStream& random, double radius_m, double bumps) {
  TriangleMesh mesh = OuterMesh({Sphere{1}, Pose()}, 0.02);
  Eigen::Matrix3d waves;
  Eigen::Vector3d phases;
  for (double& value : waves.reshaped()) value = random.Uniform(-4, 4);
  for (double& value : phases) value = random.Uniform(0, 6);
  for (auto vertex : mesh.vertices.colwise()) {
    const double bump = ((waves * vertex + phases).array().sin().sum()) / 3;
    vertex *= radius_m * (1 + bumps * bump);
  }
  return mesh;
}

/// A ring around z, of `n` by `n` corners.
inline TriangleMesh Ring(double large_m, double small_m, int n) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, n * n);
  mesh.triangles.resize(3, 2 * n * n);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * k / n;
      const double across = large_m + small_m * std::cos(v);
      mesh.vertices.col(n * i + k) << across * std::cos(u), across * std::sin(u),
          small_m * std::sin(v);
      const int next_i = (i + 1) % n, next_k = (k + 1) % n;
      const int a = n * i + k, b = n * next_i + k, c = n * next_i + next_k, d = n * i + next_k;
      mesh.triangles.col(2 * (n * i + k)) << a, b, c;
      mesh.triangles.col(2 * (n * i + k) + 1) << a, c, d;
    }
  }
  return mesh;
}

/// Points all over the surface, neighbours at most `apart_m` from each other. Shape 3 x N.
inline Eigen::Matrix3Xd DensePoints(const TriangleMesh& mesh, double apart_m) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& triangle : mesh.triangles.colwise()) {
    const Eigen::Vector3d a = mesh.vertices.col(triangle[0]), b = mesh.vertices.col(triangle[1]),
                          c = mesh.vertices.col(triangle[2]);
    const int n = std::max(
        1, static_cast<int>(
               std::ceil(std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()}) / apart_m)));
    for (int i = 0; i <= n; ++i) {
      for (int k = 0; i + k <= n; ++k) points.push_back((a * (n - i - k) + b * i + c * k) / n);
    }
  }
  Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = points[i];
  return all;
}

}  // namespace sidestep::imports
