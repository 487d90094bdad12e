#pragma once

#include <vector>

#include "sidestep/import/robot_files.h"

namespace sidestep::import {

/// The spheres that nothing can move away from what the robot stands on: those of links that never
/// move, and others that reach down to it at every configuration tried.
std::vector<int> MountSpheres(const robot::ArmDescription& arm,
                              const std::vector<robot::CollisionSphere>& spheres);

/// Of pairs of links, those whose spheres are apart at `home`: planners would find no motion free
/// that keeps the others apart.
LinkPairs SeparablePairs(const robot::ArmDescription& arm,
                         const std::vector<robot::CollisionSphere>& spheres, const LinkPairs& pairs,
                         const Eigen::VectorXd& home);

}  // namespace sidestep::import
