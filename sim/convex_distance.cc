#include "sidestep/sim/convex_distance.h"

#include <algorithm>
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
  Eigen::Matrix<double, 3, 4> points = Eigen::Matrix<double, 3, 4>::Zero();
  int size = 0;
};

// The point nearest to the origin of the plane (line, point) through a simplex, if it is inside the
// simplex.
bool ProjectOrigin(const Simplex& s, Vector3d* nearest) {
  const Vector3d p = s.points.col(0);
  const Vector3d e1 = s.points.col(1) - p, e2 = s.points.col(2) - p, e3 = s.points.col(3) - p;
  if (s.size == 1) {
    *nearest = p;
    return true;
  }
  if (s.size == 2) {
    const double u = -e1.dot(p) / e1.squaredNorm();
    *nearest = p + u * e1;
    return u > 0 && u < 1;
  }
  if (s.size == 3) {
    const double a = e1.squaredNorm(), b = e1.dot(e2), c = e2.squaredNorm();
    const double determinant = a * c - b * b;
    const double u = (b * e2.dot(p) - c * e1.dot(p)) / determinant;
    const double v = (b * e1.dot(p) - a * e2.dot(p)) / determinant;
    *nearest = p + u * e1 + v * e2;
    return u > 0 && v > 0 && u + v < 1;  // false for NaN, too
  }
  const double volume = e1.dot(e2.cross(e3));
  const double u = -p.dot(e2.cross(e3)) / volume;
  const double v = -e1.dot(p.cross(e3)) / volume;
  const double w = -e1.dot(e2.cross(p)) / volume;
  *nearest = Vector3d::Zero();
  return u > 0 && v > 0 && w > 0 && u + v + w < 1;
}

// Reduces the simplex to its smallest face that holds its point nearest to the origin.
Vector3d NearestToOrigin(Simplex* simplex) {
  Simplex best;
  Vector3d nearest = Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (unsigned corners = 1; corners < (1u << simplex->size); ++corners) {
    Simplex face;
    for (int i = 0; i < simplex->size; ++i) {
      if ((corners >> i & 1u) != 0) face.points.col(face.size++) = simplex->points.col(i);
    }
    Vector3d candidate;
    if (!ProjectOrigin(face, &candidate) || !(candidate.norm() < least)) continue;
    least = candidate.norm();
    nearest = candidate;
    best = face;
  }
  *simplex = best;
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
    simplex.points.col(simplex.size++) = w;
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
