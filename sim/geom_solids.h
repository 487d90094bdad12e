#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "sidestep/core/shape.h"

namespace sidestep::sim {

/// A convex polyhedron in its geom's frame [m]. Faces are triangles of vertices, counter-clockwise
/// seen from outside; coplanar neighbours may make up one flat face.
struct ConvexHull {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> faces;
};

/// A geom as one of core/shape.h, but for meshes; none for what that has not.
std::optional<Shape> ShapeOfGeom(const mjModel& model, int geom);

/// The convex hull that stands for a mesh wherever MuJoCo looks for contacts.
/// @throws std::invalid_argument for a mesh without one: it belongs to no geom that can touch.
ConvexHull HullOfMesh(const mjModel& model, int mesh);

/// A height field: the solid between its base and the triangles over its grid of heights, in its
/// geom's frame [m]. The triangles of a grid square meet along the diagonal from (row, column) to
/// (row + 1, column + 1), as MuJoCo's contacts and rays have them.
class HeightField {
 public:
  HeightField(const mjModel& model, int hfield);

  const Eigen::Vector2d& half_size_m() const { return half_size_m_; }  ///< x, y
  double base_m() const { return base_m_; }                            ///< z of the underside, < 0
  double top_m() const { return top_m_; }                              ///< no height is above it
  double HeightAt(double x, double y) const;                           ///< clamped to the grid
  /// The solid as prisms, one under each triangle.
  std::vector<ConvexHull> Prisms() const;

 private:
  double Height(int row, int column) const;
  Eigen::Vector3d Vertex(int row, int column) const;

  int rows_ = 0, columns_ = 0;
  const float* elevations_ = nullptr;  ///< of the model
  Eigen::Vector2d half_size_m_;
  double base_m_ = 0, top_m_ = 0;
};

}  // namespace sidestep::sim
