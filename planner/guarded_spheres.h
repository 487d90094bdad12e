#pragma once

#include <algorithm>
#include <vector>

#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// The spheres that obstacle costs and verdicts look at, all but mount spheres: their indices in
/// the robot, ascending.
inline std::vector<int> GuardedSpheres(const robot::RobotModel& robot) {
  const std::vector<int>& mount = robot.mount_spheres();
  std::vector<int> guarded;
  for (int s = 0; s < robot.num_spheres(); ++s) {
    if (!std::binary_search(mount.begin(), mount.end(), s)) guarded.push_back(s);
  }
  return guarded;
}

}  // namespace sidestep::planner
