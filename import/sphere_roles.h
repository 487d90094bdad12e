#pragma once

#include <vector>

#include "sidestep/import/robot_files.h"

namespace sidestep::imports {

/// The spheres that nothing can move away from what the robot stands on: those of links that never
/// move, and others that reach down to it at every configuration tried.
std::vector<int> MountSpheres(const robot::ArmDescription& arm,
                              const std::vector<robot::CollisionSphere>& spheres);

/// The first of some configurations at which the fewest spheres are where they would not be free:
/// those that reach down to what the robot stands on, but for the `mount` spheres, and pairs of
/// links whose spheres overlap. `configurations` must not be empty.
Eigen::VectorXd ChooseHome(const robot::ArmDescription& arm,
                           const std::vector<robot::CollisionSphere>& spheres,
                           const std::vector<int>& mount, const LinkPairs& pairs,
                           const std::vector<Eigen::VectorXd>& configurations);

/// Mount spheres, and with them those that reach below what the robot stands on at `home`, the best
/// there is: a start that lies within the floor would be none.
std::vector<int> WithSpheresBelow(const robot::ArmDescription& arm,
                                  const std::vector<robot::CollisionSphere>& spheres,
                                  const std::vector<int>& mount, const Eigen::VectorXd& home);

/// Of pairs of links, those whose spheres are apart at `home`: planners would find no motion free
/// that keeps the others apart.
LinkPairs SeparablePairs(const robot::ArmDescription& arm,
                         const std::vector<robot::CollisionSphere>& spheres, const LinkPairs& pairs,
                         const Eigen::VectorXd& home);

}  // namespace sidestep::imports
