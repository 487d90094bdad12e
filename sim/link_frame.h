#pragma once

#include <mujoco/mujoco.h>

#include <cstddef>
#include <string>

#include "sidestep/core/pose.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::sim {

/// What stands in an MJCF where the link of a joint is: the body of its name, or else a site. Of a
/// row of a Denavit-Hartenberg table, whose frames are not where bodies stand, the site `dh<row>`.
struct LinkFrame {
  bool is_site = false;
  int id = -1;       ///< of the body or the site; -1: it is not there
  std::string name;  ///< which it has, or would have
};

LinkFrame FindLinkFrame(const robot::RobotModel& robot, const mjModel& model, std::size_t joint);

/// Of a frame that is there, as MuJoCo last computed it.
Pose PoseOf(const mjData& data, const LinkFrame& frame);

}  // namespace sidestep::sim
