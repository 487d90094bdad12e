#pragma once

#include <vector>

#include "sidestep/robot/arm_description.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::imports {

/// What an arm's collision spheres are to be like.
struct SphereRequest {
  double cover_m = 0;   ///< no point of a solid stands out of its link's spheres further
  int num_spheres = 0;  ///< of all links together, at most; 0: as many as it takes
};

/// Collision spheres of an arm, link by link, as CoverLinks finds them (sphere_cover.h).
/// @throws InputError for a mesh that is not closed, and of --spheres for fewer than links with
/// solids.
std::vector<robot::CollisionSphere> CoverArm(const robot::ArmDescription& arm,
                                             const SphereRequest& request);

}  // namespace sidestep::imports
