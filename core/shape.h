#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <variant>

namespace sidestep {

class ConvexPolytope;

/// Solids, each centred on its own frame O but for the convex mesh, which lies where its vertices
/// do. Sizes in metres, all > 0.
struct Box {
  Eigen::Vector3d size_m;  ///< full edge lengths along x, y, z
};
struct Sphere {
  double radius_m;
};
struct Capsule {  ///< along z: a segment of `length_m` between the cap centres, grown by the radius
  double radius_m;
  double length_m;
};
struct Cylinder {  ///< along z
  double radius_m;
  double length_m;
};
struct Ellipsoid {
  Eigen::Vector3d semi_axes_m;
};

struct ConvexMesh {
  std::shared_ptr<const ConvexPolytope> hull;  ///< never null (core/convex_polytope.h)
};

using Shape = std::variant<Box, Sphere, Capsule, Cylinder, Ellipsoid, ConvexMesh>;

/// The exact signed distance from a point to the shape's surface [m]; negative inside.
/// @param p_OQ [m] the point in the shape's own frame, finite.
/// Source for the ellipsoid: the bisection of D. Eberly, "Distance from a Point to an Ellipse, an
/// Ellipsoid, or a Hyperellipsoid" (Geometric Tools, 2013); exact to a few ulps.
double SignedDistance(const Shape& shape, const Eigen::Vector3d& p_OQ);

/// Half the extents of the smallest box around the shape, along its own axes and centred on its
/// frame [m].
Eigen::Vector3d HalfExtents(const Shape& shape);

/// The least extent of the shape [m]; of a convex mesh across one of its faces.
double Thickness(const Shape& shape);

/// "box", "sphere", ... as written in scenario files.
std::string ShapeName(const Shape& shape);

}  // namespace sidestep
