#include "sidestep/sim/convex_distance.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace sidestep::sim {
namespace {

using Eigen::Vector3d;

constexpr double kDistanceTolerance_m = 1e-9;
constexpr int kMaxIterations = 1000;

// A point of a core, its middle where that is the origin.
Vector3d AnyPoint(const ConvexSolid& solid) {
  return solid.core == ConvexSolid::Core::kHull ? solid.vertices.front() : Vector3d::Zero();
}

struct Simplex {
  std::array<Vector3d, 4> points;
  int size = 0;
};

// Some corners of a simplex.
struct Face {
  std::array<const Vector3d*, 4> corners;
  int size = 0;
};

Face FaceOf(const Simplex& simplex, unsigned corners) {
  Face face;
  for (int i = 0; i < simplex.size; ++i) {
    if ((corners >> i & 1u) == 0) continue;
    face.corners[static_cast<std::size_t>(face.size++)] =
        &simplex.points[static_cast<std::size_t>(i)];
  }
  return face;
}

// The point nearest to the origin of the plane (line, point) through a face, if it is inside the
// face.
bool ProjectOrigin(const Face& face, Vector3d* nearest) {
  const Vector3d p = *face.corners[0];
  if (face.size == 1) {
    *nearest = p;
    return true;
  }
  const Vector3d e1 = *face.corners[1] - p;
  if (face.size == 2) {
    const double u = -e1.dot(p) / e1.squaredNorm();
    *nearest = p + u * e1;
    return u > 0 && u < 1;
  }
  const Vector3d e2 = *face.corners[2] - p;
  if (face.size == 3) {
    const double a = e1.squaredNorm(), b = e1.dot(e2), c = e2.squaredNorm();
    const double determinant = a * c - b * b;
    const double u = (b * e2.dot(p) - c * e1.dot(p)) / determinant;
    const double v = (b * e1.dot(p) - a * e2.dot(p)) / determinant;
    *nearest = p + u * e1 + v * e2;
    return u > 0 && v > 0 && u + v < 1;  // false for NaN, too
  }
  const Vector3d e3 = *face.corners[3] - p;
  const double volume = e1.dot(e2.cross(e3));
  const double u = -p.dot(e2.cross(e3)) / volume;
  const double v = -e1.dot(p.cross(e3)) / volume;
  const double w = -e1.dot(e2.cross(p)) / volume;
  *nearest = Vector3d::Zero();
  return u > 0 && v > 0 && w > 0 && u + v + w < 1;
}

// Reduces the simplex to its smallest face that holds its point nearest to the origin.
Vector3d NearestToOrigin(Simplex* simplex) {
  Face best;
  Vector3d nearest = Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (unsigned corners = 1; corners < (1u << simplex->size); ++corners) {
    const Face face = FaceOf(*simplex, corners);
    Vector3d candidate;
    if (!ProjectOrigin(face, &candidate)) continue;
    const double length = candidate.norm();
    if (!(length < least)) continue;
    least = length;
    nearest = candidate;
    best = face;
  }
  for (int i = 0; i < best.size; ++i) {  // in their order, so none is overwritten before it is read
    const auto corner = static_cast<std::size_t>(i);
    simplex->points[corner] = *best.corners[corner];
  }
  simplex->size = best.size;
  return nearest;
}

}  // namespace

double CoreDistance(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB) {
  // v runs over differences of a point of core a and a point of core b, towards the shortest one.
  // It must begin with such a difference, or it may be shorter than all of them.
  Vector3d v = -(X_AB * AnyPoint(b) - AnyPoint(a));
  Simplex simplex;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double length = v.norm();
    if (length < kDistanceTolerance_m) return 0;
    // No difference lies nearer to the origin than the plane through `w` across v.
    const Vector3d w = CoreSupport(a, -v) - X_AB * CoreSupport(b, X_AB.linear().transpose() * v);
    if (length - v.dot(w) / length <= kDistanceTolerance_m) break;
    simplex.points[static_cast<std::size_t>(simplex.size++)] = w;
    const Vector3d next = NearestToOrigin(&simplex);
    if (simplex.size == 4) return 0;            // the origin is inside: the cores overlap
    if (i > 0 && next.norm() >= length) break;  // as near as rounding allows
    v = next;
  }
  return v.norm();
}

double ConvexDistance(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB) {
  return std::max(0.0, CoreDistance(a, b, X_AB) - a.radius_m - b.radius_m);
}

}  // namespace sidestep::sim
