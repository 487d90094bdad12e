#include "sidestep/import/outer_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <variant>
#include <vector>

#include "sidestep/core/convex_polytope.h"

namespace sidestep::imports {
namespace {

using Eigen::Vector3d;

class MeshMaker {
 public:
  int AddVertex(const Vector3d& p) {
    vertices_.push_back(p);
    return static_cast<int>(vertices_.size()) - 1;
  }
  void AddTriangle(int a, int b, int c) { triangles_.emplace_back(a, b, c); }
  void AddQuad(int a, int b, int c, int d) {
    AddTriangle(a, b, c);
    AddTriangle(a, c, d);
  }
  TriangleMesh Make() const {
    TriangleMesh mesh;
    mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      mesh.vertices.col(static_cast<Eigen::Index>(i)) = vertices_[i];
    }
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      mesh.triangles.col(static_cast<Eigen::Index>(i)) = triangles_[i];
    }
    return mesh;
  }

 private:
  std::vector<Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

// Corners around a circle so that a polygon around it stands out by no more than the tolerance; of
// a ball of as many meridians, and half as many bands, what stands out is twice that.
int NumAround(double radius_m, double tolerance_m) {
  const double angle = std::sqrt(tolerance_m / radius_m);
  const int quarters = static_cast<int>(std::ceil(std::min(std::numbers::pi / angle, 512.0) / 4));
  return 4 * std::clamp(quarters, 2, 128);
}

TriangleMesh OuterBox(const Vector3d& half) {
  MeshMaker maker;
  for (int i = 0; i < 8; ++i) {
    maker.AddVertex(half.cwiseProduct(
        Vector3d((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1)));
  }
  for (const auto& [a, b, c, d] : std::initializer_list<std::array<int, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    maker.AddQuad(a, b, c, d);
  }
  return maker.Make();
}

// A stack of rings, closed at both ends by a point.
// @param rings (radius, z) from the lowest to the highest.
TriangleMesh Turned(const std::vector<Eigen::Vector2d>& rings, double bottom, double top, int n) {
  MeshMaker maker;
  const int low = maker.AddVertex({0, 0, bottom}), high = maker.AddVertex({0, 0, top});
  std::vector<int> first;
  for (const Eigen::Vector2d& ring : rings) {
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      const int vertex =
          maker.AddVertex({ring.x() * std::cos(angle), ring.x() * std::sin(angle), ring.y()});
      if (i == 0) first.push_back(vertex);
    }
  }
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    maker.AddTriangle(low, first.front() + next, first.front() + i);
    maker.AddTriangle(high, first.back() + i, first.back() + next);
    for (std::size_t k = 0; k + 1 < first.size(); ++k) {
      maker.AddQuad(first[k] + i, first[k] + next, first[k + 1] + next, first[k + 1] + i);
    }
  }
  return maker.Make();
}

TriangleMesh OuterCylinder(double radius_m, double length_m, double tolerance_m) {
  const int n = NumAround(radius_m, tolerance_m);
  const double around = radius_m / std::cos(std::numbers::pi / n);
  const double half = length_m / 2;
  return Turned({{around, -half}, {around, half}}, -half, half, n);
}

// Around a ball, pulled apart by `length_m` at its equator.
TriangleMesh OuterCapsule(double radius_m, double length_m, double tolerance_m) {
  const int n = NumAround(radius_m, tolerance_m);
  const int bands = n / 2;
  const double chord = std::cos(std::numbers::pi / n);
  // Every facet touches a smaller ball, or comes nearest to it beyond its rim.
  double inner = 1;
  for (int k = 0; k < bands; ++k) {
    const double a = std::numbers::pi * k / bands, b = std::numbers::pi * (k + 1) / bands;
    const Eigen::Vector2d p(chord * std::sin(a), std::cos(a)), q(chord * std::sin(b), std::cos(b));
    const double cross = p.x() * q.y() - p.y() * q.x();
    inner = std::min(inner, std::abs(cross) / (p - q).norm());
  }
  const double scale = radius_m / inner, half = length_m / 2;
  std::vector<Eigen::Vector2d> rings;
  for (int k = 1; k < bands; ++k) {
    const double angle = std::numbers::pi * (k - bands / 2.0) / bands;
    const Eigen::Vector2d ring(scale * std::cos(angle), scale * std::sin(angle));
    const bool is_equator = 2 * k == bands;
    if (is_equator && length_m > 0) {
      rings.emplace_back(ring.x(), -half);
      rings.emplace_back(ring.x(), half);
      continue;
    }
    rings.emplace_back(ring.x(), ring.y() + (2 * k < bands ? -half : 2 * k > bands ? half : 0));
  }
  return Turned(rings, -scale - half, scale + half, n);
}

struct MakeOuter {
  double tolerance_m;
  TriangleMesh operator()(const Box& box) const { return OuterBox(box.size_m / 2); }
  TriangleMesh operator()(const Sphere& sphere) const {
    return OuterCapsule(sphere.radius_m, 0, tolerance_m);
  }
  TriangleMesh operator()(const Capsule& capsule) const {
    return OuterCapsule(capsule.radius_m, capsule.length_m, tolerance_m);
  }
  TriangleMesh operator()(const Cylinder& cylinder) const {
    return OuterCylinder(cylinder.radius_m, cylinder.length_m, tolerance_m);
  }
  TriangleMesh operator()(const Ellipsoid& ellipsoid) const {
    const double longest = ellipsoid.semi_axes_m.maxCoeff();
    TriangleMesh mesh = OuterCapsule(1, 0, tolerance_m / longest);
    mesh.vertices = ellipsoid.semi_axes_m.asDiagonal() * mesh.vertices;
    return mesh;
  }
  TriangleMesh operator()(const ConvexMesh& convex) const {
    TriangleMesh mesh;
    const auto& vertices = convex.hull->vertices();
    const auto& triangles = convex.hull->triangles();
    mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      mesh.vertices.col(static_cast<Eigen::Index>(i)) = vertices[i];
    }
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      mesh.triangles.col(static_cast<Eigen::Index>(i)) =
          Eigen::Map<const Eigen::Vector3i>(triangles[i].corners.data());
    }
    return mesh;
  }
};

}  // namespace

TriangleMesh OuterMesh(const PlacedShape& placed, double tolerance_m) {
  TriangleMesh mesh = std::visit(MakeOuter{tolerance_m}, placed.shape);
  mesh.vertices = (placed.X_WO.rotation().toRotationMatrix() * mesh.vertices).colwise() +
                  placed.X_WO.translation();
  return mesh;
}

}  // namespace sidestep::imports
