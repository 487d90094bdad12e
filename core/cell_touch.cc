#include "sidestep/core/cell_touch.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "sidestep/core/convex_polytope.h"

namespace sidestep {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Pairs of CubeTouch::Corners that differ along one axis.
constexpr std::array<std::pair<std::size_t, std::size_t>, 12> kCubeEdges = {{{0, 1},
                                                                             {0, 2},
                                                                             {0, 4},
                                                                             {1, 3},
                                                                             {1, 5},
                                                                             {2, 3},
                                                                             {2, 6},
                                                                             {3, 7},
                                                                             {4, 5},
                                                                             {4, 6},
                                                                             {5, 7},
                                                                             {6, 7}}};

// The least distance from the origin to points of the convex hull of others, 0 if it is inside.
template <std::size_t kMost>
double DistanceToHull(std::array<Vector2d, kMost>& points, std::size_t count) {
  const auto cross = [](const Vector2d& a, const Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  std::sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Vector2d& a, const Vector2d& b) {
              return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
            });
  // Both chains of A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions",
  // Information Processing Letters 9(5):216-219, 1979; counter-clockwise.
  std::array<Vector2d, 2 * kMost> hull;
  std::size_t size = 0;
  const auto add = [&](const Vector2d& p, std::size_t least) {
    while (size >= least + 2 && cross(hull[size - 1] - hull[size - 2], p - hull[size - 2]) <= 0) {
      --size;
    }
    hull[size++] = p;
  };
  for (std::size_t i = 0; i < count; ++i) add(points[i], 0);
  const std::size_t lower = size - 1;
  for (std::size_t i = count - 1; i-- > 0;) add(points[i], lower);
  if (size == 1) return hull[0].norm();
  bool is_inside = true;
  double least = hull[0].norm();
  for (std::size_t i = 0; i + 1 < size; ++i) {
    const Vector2d edge = hull[i + 1] - hull[i];
    is_inside = is_inside && cross(edge, -hull[i]) >= 0;
    const double along = edge.squaredNorm() > 0 ? -hull[i].dot(edge) / edge.squaredNorm() : 0;
    least = std::min(least, (hull[i] + std::clamp(along, 0.0, 1.0) * edge).norm());
  }
  return is_inside ? 0 : least;
}

// The least |f + E u| over -1 <= u <= 1, or the first that is found to be at most `enough`. The
// minimum is that of the plane, line or point which one of the 27 faces of the cube of u lies in.
double LeastOverCube(const Vector3d& f, const Eigen::Matrix3d& E, double enough) {
  double least = f.norm();
  for (int face = 0; face < 27 && least > enough; ++face) {
    const std::array<int, 3> sign = {face % 3 - 1, face / 3 % 3 - 1, face / 9 - 1};  // 0: free
    Vector3d at = f;
    Eigen::Matrix3d free = Eigen::Matrix3d::Zero();
    int num_free = 0;
    for (int a = 0; a < 3; ++a) {
      const int s = sign[static_cast<std::size_t>(a)];
      if (s == 0) {
        free.col(num_free++) = E.col(a);
      } else {
        at += s * E.col(a);
      }
    }
    if (num_free > 0) {
      Vector3d u = Vector3d::Zero();
      if (num_free == 1) {
        u(0) = -free.col(0).dot(at) / free.col(0).squaredNorm();
      } else if (num_free == 2) {
        const Eigen::Matrix<double, 3, 2> plane = free.leftCols<2>();
        const Eigen::Matrix2d normal = plane.transpose() * plane;
        u.head<2>() = -(normal.inverse() * (plane.transpose() * at));
      } else {
        u = -(free.inverse() * at);
      }
      if (!(u.cwiseAbs().maxCoeff() <= 1)) continue;
      at += free * u;
    }
    least = std::min(least, at.norm());
  }
  return least;
}

}  // namespace

CubeTouch::CubeTouch(const Shape& shape, const Eigen::Matrix3d& R_WO, const Vector3d& p_WO,
                     double edge_m)
    : shape_(shape),
      R_OW_(R_WO.transpose()),
      p_WO_(p_WO),
      half_m_(edge_m / 2 - kOnSurface_m),
      R_abs_(R_OW_.cwiseAbs()),
      reach_m_(half_m_ * R_abs_.rowwise().sum()) {}

bool CubeTouch::operator()(const Vector3d& p_WCenter) const {
  const Vector3d p_OC = R_OW_ * (p_WCenter - p_WO_);
  return std::visit([&](const auto& shape) { return Reaches(shape, p_OC); }, shape_);
}

Vector3d CubeTouch::NearestInCube(const Vector3d& p_OC, const Vector3d& p_OQ) const {
  const Vector3d p_CQ_W = R_OW_.transpose() * (p_OQ - p_OC);
  return p_OC + R_OW_ * p_CQ_W.cwiseMax(-half_m_).cwiseMin(half_m_);
}

std::array<Vector3d, 8> CubeTouch::Corners(const Vector3d& p_OC) const {
  std::array<Vector3d, 8> corners;
  for (std::size_t n = 0; n < 8; ++n) {
    corners[n] = p_OC + R_OW_ * Vector3d((n & 1) != 0 ? half_m_ : -half_m_,
                                         (n & 2) != 0 ? half_m_ : -half_m_,
                                         (n & 4) != 0 ? half_m_ : -half_m_);
  }
  return corners;
}

// By separating axes: S. Gottschalk, M. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996, section 5.
bool CubeTouch::Reaches(const Box& box, const Vector3d& p_OC) const {
  const Vector3d half = box.size_m / 2;
  const Vector3d apart = p_OC.cwiseAbs();
  if ((apart.array() > (half + reach_m_).array()).any()) return false;
  if ((apart.array() <= half.array()).all()) return true;
  const Vector3d box_reach = R_abs_.transpose() * half;  // along the cube's axes
  const Vector3d p_OC_W = R_OW_.transpose() * p_OC;
  if ((p_OC_W.cwiseAbs().array() > box_reach.array() + half_m_).any()) return false;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      // Across an axis of the box and one of the cube; none where the two are parallel.
      const double x1 = -R_OW_(i2, j), x2 = R_OW_(i1, j);
      if (x1 * x1 + x2 * x2 < 1e-12) continue;
      const double box_m = half(i1) * std::abs(x1) + half(i2) * std::abs(x2);
      const double cube_m = half_m_ * (R_abs_(i, (j + 1) % 3) + R_abs_(i, (j + 2) % 3));
      if (std::abs(p_OC(i1) * x1 + p_OC(i2) * x2) > box_m + cube_m) return false;
    }
  }
  return true;
}

bool CubeTouch::Reaches(const Sphere& sphere, const Vector3d& p_OC) const {
  return NearestInCube(p_OC, Vector3d::Zero()).norm() <= sphere.radius_m;
}

// The squared distance to the cube along the capsule's axis is convex and, between the places where
// the axis passes the planes of the cube's faces, a parabola.
bool CubeTouch::Reaches(const Capsule& capsule, const Vector3d& p_OC) const {
  const double half_length_m = capsule.length_m / 2;
  const Vector3d from = R_OW_.transpose() * -p_OC;  // the middle of the axis, seen from the cube
  const Vector3d along = half_length_m * R_OW_.row(2).transpose();
  const auto outside = [&](double t) -> Vector3d {
    const Vector3d q = from + t * along;
    return q - q.cwiseMax(-half_m_).cwiseMin(half_m_);
  };
  const auto slope = [&](double t) { return outside(t).dot(along); };
  // The last kink, or end, from which it goes down, and the first from which it does not.
  double down = -1, up = 1;
  if (slope(down) >= 0) return outside(down).norm() <= capsule.radius_m;
  if (slope(up) <= 0) return outside(up).norm() <= capsule.radius_m;
  for (int a = 0; a < 3; ++a) {
    for (const double face_m : {-half_m_, half_m_}) {
      const double t = (face_m - from(a)) / along(a);
      if (!(t > down && t < up)) continue;  // NaN, too
      (slope(t) < 0 ? down : up) = t;
    }
  }
  const double before = slope(down), after = slope(up);
  const double lowest = down + (up - down) * before / (before - after);
  return outside(lowest).norm() <= capsule.radius_m;
}

// The part of the cube that is between the planes of the cylinder's ends, seen along its axis.
bool CubeTouch::Reaches(const Cylinder& cylinder, const Vector3d& p_OC) const {
  const double half_length_m = cylinder.length_m / 2, radius_m = cylinder.radius_m;
  if (std::abs(p_OC.z()) > half_length_m + reach_m_.z()) return false;
  const double off_axis_m = p_OC.head<2>().norm();
  if (off_axis_m > radius_m) {  // and behind a plane that touches the cylinder's side?
    const Vector3d out(p_OC.x() / off_axis_m, p_OC.y() / off_axis_m, 0);
    const double reach_m = half_m_ * (R_OW_.transpose() * out).cwiseAbs().sum();
    if (off_axis_m > radius_m + reach_m) return false;
  } else if (std::abs(p_OC.z()) <= half_length_m) {
    return true;
  }
  const std::array<Vector3d, 8> corners = Corners(p_OC);
  std::array<Vector2d, 32> seen;  // corners between the planes, and where edges pass those
  std::size_t num_seen = 0;
  for (const Vector3d& corner : corners) {
    if (std::abs(corner.z()) <= half_length_m) seen[num_seen++] = corner.head<2>();
  }
  for (const auto& [from, to] : kCubeEdges) {
    const Vector3d &a = corners[from], &b = corners[to];
    for (const double end_m : {-half_length_m, half_length_m}) {
      if ((a.z() < end_m) == (b.z() < end_m)) continue;
      const double along = (end_m - a.z()) / (b.z() - a.z());
      seen[num_seen++] = a.head<2>() + along * (b.head<2>() - a.head<2>());
    }
  }
  return num_seen > 0 && DistanceToHull(seen, num_seen) <= radius_m;
}

// In coordinates in which the ellipsoid is the unit ball and the cube a parallelepiped.
bool CubeTouch::Reaches(const Ellipsoid& ellipsoid, const Vector3d& p_OC) const {
  const Vector3d& axes = ellipsoid.semi_axes_m;
  if (NearestInCube(p_OC, Vector3d::Zero()).cwiseQuotient(axes).norm() <= 1) return true;
  // Behind a plane that touches the ellipsoid near the cube?
  const Vector3d normal = p_OC.cwiseQuotient(axes.cwiseProduct(axes));
  const double reach_m = half_m_ * (R_OW_.transpose() * normal).cwiseAbs().sum();
  if (normal.dot(p_OC) - reach_m > axes.cwiseProduct(normal).norm()) return false;
  const Vector3d center = p_OC.cwiseQuotient(axes);
  const Eigen::Matrix3d half_edges = axes.cwiseInverse().asDiagonal() * (half_m_ * R_OW_);
  return LeastOverCube(center, half_edges, 1) <= 1;
}

// Two convex polyhedra share a point iff an edge of one meets the other.
bool CubeTouch::Reaches(const ConvexMesh& mesh, const Vector3d& p_OC) const {
  const ConvexPolytope& hull = *mesh.hull;
  bool has_center = true;
  for (const ConvexPolytope::Triangle& face : hull.triangles()) {
    const double height_m = face.normal.dot(p_OC) - face.offset_m;
    if (height_m > half_m_ * (R_OW_.transpose() * face.normal).cwiseAbs().sum()) return false;
    has_center = has_center && height_m <= 0;
  }
  if (has_center) return true;
  // The part of a way from a to b for which all heights, which change evenly, are at most 0.
  const auto cut = [](double at_a, double at_b, double& begin, double& end) {
    if (at_a > 0 && at_b > 0) end = -1;
    if (at_a > 0 && at_b <= 0) begin = std::max(begin, at_a / (at_a - at_b));
    if (at_a <= 0 && at_b > 0) end = std::min(end, at_a / (at_a - at_b));
  };
  const auto from_cube = [&](int vertex) -> Vector3d {
    return R_OW_.transpose() * (hull.vertices()[static_cast<std::size_t>(vertex)] - p_OC);
  };
  for (const ConvexPolytope::Edge& edge : hull.edges()) {
    const Vector3d a = from_cube(edge.from), b = from_cube(edge.to);
    double begin = 0, end = 1;
    for (int axis = 0; axis < 3; ++axis) {
      cut(a(axis) - half_m_, b(axis) - half_m_, begin, end);
      cut(-half_m_ - a(axis), -half_m_ - b(axis), begin, end);
    }
    if (begin <= end) return true;
  }
  const std::array<Vector3d, 8> corners = Corners(p_OC);
  for (const auto& [from, to] : kCubeEdges) {
    double begin = 0, end = 1;
    for (const ConvexPolytope::Triangle& face : hull.triangles()) {
      cut(face.normal.dot(corners[from]) - face.offset_m,
          face.normal.dot(corners[to]) - face.offset_m, begin, end);
      if (begin > end) break;
    }
    if (begin <= end) return true;
  }
  return false;
}

}  // namespace sidestep
