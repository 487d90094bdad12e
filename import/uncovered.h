#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/import/cover_sphere.h"
#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {

/// How far the surface of meshes sticks out of a union of spheres at its worst point.
struct Uncovered {
  double at_most_m =
      0;  ///< no point sticks out further, for certain; negative: all are deep inside
  double at_least_m = 0;  ///< that of the point below
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
};

/// By branch and bound over pieces of triangles: the distance to a sphere is convex, so that a
/// piece sticks out of it no further than one of its corners does.
/// @param spheres at least one. @param meshes at least one triangle in all.
/// @param gap_m > 0: the two bounds are no further apart, unless that takes more than two million
///   pieces; `at_most_m` holds in any case.
Uncovered FindUncovered(const std::vector<TriangleMesh>& meshes,
                        const std::vector<CoverSphere>& spheres, double gap_m);

/// Points of the surface that stick out of all spheres by more than `cover_m`, from all places
/// where it does over a width of `apart_m` or more, and about as far from each other. Shape 3 x N.
Eigen::Matrix3Xd FindOutside(const std::vector<TriangleMesh>& meshes,
                             const std::vector<CoverSphere>& spheres, double cover_m,
                             double apart_m);

/// Makes spheres larger until no point of the surface sticks out of them by more than `cover_m`,
/// for certain: each piece of the surface ends within `cover_m` of one sphere.
/// @param steps_per_m > 0: a sphere that grows gets a whole number of steps as its radius; pieces
/// no
///   longer than a step are not cut further.
void GrowToCover(const std::vector<TriangleMesh>& meshes, double cover_m, double steps_per_m,
                 std::vector<CoverSphere>* spheres);

}  // namespace sidestep::imports
