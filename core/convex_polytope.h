#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace sidestep {

/// The convex hull of points, in their frame O [m]: a solid bounded by triangles. Immutable.
///
/// Which points are its corners is decided exactly: of each coordinate the part counts that is a
/// whole number of 2^-40 of the largest one's power of two (a picometre of a metre), in whole
/// numbers of 128 bits. So flat faces of many corners, such as those of boxes and cylinders, are no
/// special case, and the hull of the corners alone is the same again.
class ConvexPolytope {
 public:
  /// A part of a flat face.
  struct Triangle {
    std::array<int, 3> corners;  ///< vertices, counter-clockwise seen from outside
    Eigen::Vector3d normal;      ///< outwards, of unit length
    double offset_m;             ///< normal . p of its points
  };
  /// Where two faces meet at an angle.
  struct Edge {
    int from, to;  ///< vertices
  };
  struct Distance {
    double distance_m;         ///< negative inside
    Eigen::Vector3d gradient;  ///< of unit length; of one of several nearest points
  };

  /// More corners are refused: every question is asked of each of them.
  static constexpr std::size_t kMostVertices = 1000;

  /// @throws std::invalid_argument with what is wrong with the points: fewer than 4, not finite, in
  ///   one plane, or with more corners than kMostVertices.
  explicit ConvexPolytope(const std::vector<Eigen::Vector3d>& points_m);

  /// Those of the points that are corners, in the points' order.
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Edge>& edges() const { return edges_; }
  /// Half the extents of the smallest box about the origin that holds it.
  const Eigen::Vector3d& half_extents_m() const { return half_extents_m_; }
  /// The least extent across one of its faces.
  double thickness_m() const { return thickness_m_; }

  /// The exact signed distance from a point to the surface [m]: outside that to the nearest of the
  /// triangles, inside that to the nearest plane of one.
  double SignedDistance(const Eigen::Vector3d& p_OQ) const { return Nearest(p_OQ).distance_m; }
  /// ... and its gradient.
  Distance Nearest(const Eigen::Vector3d& p_OQ) const;

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;
  Eigen::Vector3d half_extents_m_ = Eigen::Vector3d::Zero();
  double thickness_m_ = 0;
};

}  // namespace sidestep
