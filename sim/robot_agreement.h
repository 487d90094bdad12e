#pragma once

#include <mujoco/mujoco.h>

#include <string>

#include "sidestep/robot/robot_model.h"

namespace sidestep::sim {

/// A robot is described twice: by robot.yaml, from which is planned, and by its MJCF, which is
/// simulated. Checks that both speak of the same arm: joints, their kinds, order and ranges; a
/// plain torque motor for each, of the same limit; joints that mimic others, and are tied to them
/// by an `equality`, the same; geoms that are solids or pictures; the
/// frame of each link where the body or site of its name is, after a row of a Denavit-Hartenberg
/// table the site `dh<row>`, at random configurations; links that exist. What four written digits
/// leave (0.1 mm, 1e-4 rad, 1e-4 of a torque) is no difference. Takes well under a millisecond.
///
/// @param model the robot's MJCF, compiled alone or as part of a world (with robot.X_WB() there).
/// @param mjcf_path where the MJCF was read, for lines.
/// @throws InputError at the line of robot.yaml where two values differ, with both, and at the line
///   of the MJCF where that is wrong by itself.
void CheckAgreement(const robot::RobotModel& robot, const mjModel& model,
                    const std::string& mjcf_path);

}  // namespace sidestep::sim
