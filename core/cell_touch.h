#pragma once

#include <Eigen/Core>
#include <array>

#include "sidestep/core/shape.h"

namespace sidestep {

/// Which cells of a grid a solid fills.
enum class CellRule {
  kTouched,  ///< every cell that it reaches into: nothing is thinner than a map can hold
  kCentre,   ///< the cells whose centre is inside: volumes are right, thin things fall between
};

/// Tells which cubes of one size, with their faces across the axes of W, a solid reaches into: a
/// cube and the solid must share more than a surface, or a box that stands on the faces of cells
/// would fill those beyond its faces, too. Exact for every shape; what overlaps by less than
/// kOnSurface_m does not count.
class CubeTouch {
 public:
  static constexpr double kOnSurface_m = 1e-9;

  /// @param shape must outlive this. @param R_WO, p_WO its pose. @param edge_m > 0, of the cubes.
  CubeTouch(const Shape& shape, const Eigen::Matrix3d& R_WO, const Eigen::Vector3d& p_WO,
            double edge_m);

  bool operator()(const Eigen::Vector3d& p_WCenter) const;

 private:
  bool Reaches(const Box& box, const Eigen::Vector3d& p_OC) const;
  bool Reaches(const Sphere& sphere, const Eigen::Vector3d& p_OC) const;
  bool Reaches(const Capsule& capsule, const Eigen::Vector3d& p_OC) const;
  bool Reaches(const Cylinder& cylinder, const Eigen::Vector3d& p_OC) const;
  bool Reaches(const Ellipsoid& ellipsoid, const Eigen::Vector3d& p_OC) const;
  bool Reaches(const ConvexMesh& mesh, const Eigen::Vector3d& p_OC) const;

  // Of the cube around C, in O; the bits of a number say on which side of C along x, y, z.
  std::array<Eigen::Vector3d, 8> Corners(const Eigen::Vector3d& p_OC) const;
  // The point of the cube around C that is nearest to a point.
  Eigen::Vector3d NearestInCube(const Eigen::Vector3d& p_OC, const Eigen::Vector3d& p_OQ) const;

  const Shape& shape_;
  Eigen::Matrix3d R_OW_;  ///< the columns are the cube's axes
  Eigen::Vector3d p_WO_;
  double half_m_;            ///< of the edges, less kOnSurface_m
  Eigen::Matrix3d R_abs_;    ///< R_OW_ without signs
  Eigen::Vector3d reach_m_;  ///< of the cube from its centre along each axis of O
};

}  // namespace sidestep
