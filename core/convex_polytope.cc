#include "sidestep/core/convex_polytope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace sidestep {
namespace {

using Eigen::Vector3d;

// Of a hull that grows; a solid has some two for each corner.
constexpr std::size_t kMostFaces = 8 * ConvexPolytope::kMostVertices;

// Coordinates are below 2^40: a determinant of three differences stays below 2^126.
constexpr int kBits = 40;

__extension__ using Wide = __int128;
using Whole = std::array<std::int64_t, 3>;

// Points as whole numbers.
struct Lattice {
  double step_m = 1;
  std::vector<Whole> points;
};

Lattice LatticeOf(const std::vector<Vector3d>& points_m) {
  double largest = 0;
  for (const Vector3d& p : points_m) {
    if (!p.allFinite()) throw std::invalid_argument("must be finite");
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  Lattice lattice;
  if (largest > 0) lattice.step_m = std::ldexp(1.0, std::ilogb(largest) + 1 - kBits);
  for (const Vector3d& p : points_m) {
    // Towards zero, so that the largest keeps its power of two.
    const auto whole = [&](double x) { return static_cast<std::int64_t>(x / lattice.step_m); };
    lattice.points.push_back({whole(p.x()), whole(p.y()), whole(p.z())});
  }
  return lattice;
}

std::array<Wide, 3> Normal(const Whole& a, const Whole& b, const Whole& c) {
  const Wide u[] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Wide v[] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

// Builds a hull by adding one point after the other: what a new point sees of the hull so far is
// taken away, and the rim of that joined to it. As signs are exact, what is seen is always one
// patch.
class HullBuilder {
 public:
  explicit HullBuilder(const std::vector<Whole>& points) : points_(points) {
    Begin();
    for (int i = 0; i < static_cast<int>(points.size()); ++i) Add(i);
  }

  // Corners of triangles, as numbers of points.
  std::vector<std::array<int, 3>> Triangles() const {
    std::vector<std::array<int, 3>> triangles;
    for (const Face& face : faces_) {
      if (face.is_there) triangles.push_back(face.corners);
    }
    return triangles;
  }

  // Edges (from < to) at which two triangles meet at an angle.
  std::vector<std::pair<int, int>> Edges() const {
    std::vector<std::pair<int, int>> edges;
    for (const auto& [edge, face] : face_at_) {
      const auto& [from, to] = edge;
      if (from > to) continue;
      const Face& other = faces_[static_cast<std::size_t>(face_at_.at({to, from}))];
      for (const int corner : other.corners) {
        if (corner == from || corner == to) continue;
        if (Height(faces_[static_cast<std::size_t>(face)], corner) != 0) edges.push_back(edge);
      }
    }
    return edges;
  }

 private:
  struct Face {
    std::array<int, 3> corners;
    std::array<Wide, 3> normal;
    bool is_there = true;
  };

  const Whole& At(int point) const { return points_[static_cast<std::size_t>(point)]; }

  // Above 0 where the point sees the face.
  Wide Height(const Face& face, int point) const {
    const Whole &a = At(face.corners[0]), &p = At(point);
    Wide height = 0;
    for (std::size_t i = 0; i < 3; ++i) height += face.normal[i] * (p[i] - a[i]);
    return height;
  }

  void AddFace(int a, int b, int c) {
    int face = static_cast<int>(faces_.size());
    if (unused_.empty()) {
      if (faces_.size() >= kMostFaces) throw std::invalid_argument("have too many corners");
      faces_.emplace_back();
    } else {
      face = unused_.back();
      unused_.pop_back();
    }
    faces_[static_cast<std::size_t>(face)] = {{a, b, c}, Normal(At(a), At(b), At(c))};
    face_at_[{a, b}] = face_at_[{b, c}] = face_at_[{c, a}] = face;
  }

  // The first points that span a solid.
  void Begin() {
    const int n = static_cast<int>(points_.size());
    const auto is_zero = [](const std::array<Wide, 3>& v) {
      return v[0] == 0 && v[1] == 0 && v[2] == 0;
    };
    int b = 1;
    while (b < n && At(b) == At(0)) ++b;
    if (b >= n) throw std::invalid_argument("are all one point");
    int c = b + 1;
    while (c < n && is_zero(Normal(At(0), At(b), At(c)))) ++c;
    if (c >= n) throw std::invalid_argument("lie on one line");
    const Face face{{0, b, c}, Normal(At(0), At(b), At(c))};
    int d = c + 1;
    while (d < n && Height(face, d) == 0) ++d;
    if (d >= n) throw std::invalid_argument("lie in one plane");
    if (Height(face, d) > 0) std::swap(b, c);
    AddFace(0, b, c);
    AddFace(0, c, d);
    AddFace(c, b, d);
    AddFace(b, 0, d);
  }

  void Add(int point) {
    std::vector<int> seen;
    std::vector<char> is_seen(faces_.size(), 0);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!faces_[f].is_there || Height(faces_[f], point) <= 0) continue;
      seen.push_back(static_cast<int>(f));
      is_seen[f] = 1;
    }
    std::vector<std::pair<int, int>> rim;
    for (const int f : seen) {
      const std::array<int, 3>& corners = faces_[static_cast<std::size_t>(f)].corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const int from = corners[k], to = corners[(k + 1) % 3];
        const int other = face_at_.at({to, from});
        if (is_seen[static_cast<std::size_t>(other)] == 0) rim.push_back({from, to});
      }
    }
    for (const int f : seen) {
      Face& face = faces_[static_cast<std::size_t>(f)];
      for (std::size_t k = 0; k < 3; ++k) {
        face_at_.erase({face.corners[k], face.corners[(k + 1) % 3]});
      }
      face.is_there = false;
      unused_.push_back(f);
    }
    for (const auto& [from, to] : rim) AddFace(from, to, point);
  }

  const std::vector<Whole>& points_;
  std::vector<Face> faces_;
  std::vector<int> unused_;                     // places among the faces
  std::map<std::pair<int, int>, int> face_at_;  // left of the way from one corner to the next
};

// The point of a triangle that is nearest to p: C. Ericson, "Real-Time Collision Detection" (2005),
// section 5.1.5.
Vector3d NearestOfTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                           const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double all = va + vb + vc;
  return all > 0 ? a + (vb * ab + vc * ac) / all : a;  // of a sliver its neighbours tell more
}

}  // namespace

ConvexPolytope::ConvexPolytope(const std::vector<Vector3d>& points_m) {
  if (points_m.size() < 4) throw std::invalid_argument("must be at least 4 points");
  const Lattice lattice = LatticeOf(points_m);
  // A corner is where three edges meet or more; a point amid an edge or a face is none. The hull of
  // the corners has no others.
  std::vector<int> number_of_edges(points_m.size(), 0);
  for (const auto& [from, to] : HullBuilder(lattice.points).Edges()) {
    ++number_of_edges[static_cast<std::size_t>(from)];
    ++number_of_edges[static_cast<std::size_t>(to)];
  }
  std::vector<Whole> corners;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    if (number_of_edges[i] < 3) continue;
    corners.push_back(lattice.points[i]);
    vertices_.push_back(points_m[i]);
    half_extents_m_ = half_extents_m_.cwiseMax(points_m[i].cwiseAbs());
  }
  if (corners.size() > kMostVertices) {
    throw std::invalid_argument("have " + std::to_string(corners.size()) +
                                " corners, must be at most " + std::to_string(kMostVertices));
  }
  const HullBuilder hull(corners);
  for (const auto& [from, to] : hull.Edges()) edges_.push_back({from, to});
  thickness_m_ = std::numeric_limits<double>::infinity();
  for (const std::array<int, 3>& triangle : hull.Triangles()) {
    const auto corner = [&](std::size_t k) {
      return corners[static_cast<std::size_t>(triangle[k])];
    };
    const std::array<Wide, 3> normal = Normal(corner(0), corner(1), corner(2));
    const Vector3d along(static_cast<double>(normal[0]), static_cast<double>(normal[1]),
                         static_cast<double>(normal[2]));
    const Vector3d unit = (along / along.cwiseAbs().maxCoeff()).normalized();
    const double offset_m = unit.dot(vertices_[static_cast<std::size_t>(triangle[0])]);
    triangles_.push_back({triangle, unit, offset_m});
    double lowest_m = offset_m;
    for (const Vector3d& vertex : vertices_) lowest_m = std::min(lowest_m, unit.dot(vertex));
    thickness_m_ = std::min(thickness_m_, offset_m - lowest_m);
  }
}

ConvexPolytope::Distance ConvexPolytope::Nearest(const Vector3d& p_OQ) const {
  Distance highest{-std::numeric_limits<double>::infinity(), Vector3d::UnitX()};
  for (const Triangle& triangle : triangles_) {
    const double height_m = triangle.normal.dot(p_OQ) - triangle.offset_m;
    if (height_m > highest.distance_m) highest = {height_m, triangle.normal};
  }
  if (highest.distance_m <= 0) return highest;
  // Outside, the nearest point lies on a triangle whose outer side p sees.
  double least_m2 = std::numeric_limits<double>::infinity();
  Vector3d away = highest.gradient;
  for (const Triangle& triangle : triangles_) {
    const double height_m = triangle.normal.dot(p_OQ) - triangle.offset_m;
    if (height_m <= 0 || height_m * height_m >= least_m2) continue;
    const auto vertex = [&](std::size_t k) -> const Vector3d& {
      return vertices_[static_cast<std::size_t>(triangle.corners[k])];
    };
    const Vector3d out = p_OQ - NearestOfTriangle(p_OQ, vertex(0), vertex(1), vertex(2));
    if (out.squaredNorm() >= least_m2) continue;
    least_m2 = out.squaredNorm();
    away = out;
  }
  const double distance_m = std::max(std::sqrt(least_m2), highest.distance_m);
  // Near the surface a difference of points has no direction any more; the plane has.
  const bool is_on_surface = distance_m < 1e-7 * half_extents_m_.maxCoeff();
  return {distance_m, is_on_surface ? highest.gradient : away.normalized()};
}

}  // namespace sidestep
