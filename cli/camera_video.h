#pragma once

#include <string>

#include "sidestep/core/pose.h"
#include "sidestep/record/recording.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::cli {

/// Writes a video of what a camera saw, and of what was made of it: its pictures with the tags that
/// were found, the boxes where they were seen and where they were expected half a second, one and
/// one and a half later, and where the plan would move the tool.
/// @param folder of a LookLog. @param recording of the run that looked.
/// @throws InputError if the folder holds no such log, or the video cannot be written.
void WriteCameraVideo(const std::string& folder, const Pose& X_WC,
                      const record::Recording& recording, const robot::RobotModel& robot,
                      const std::string& path);

}  // namespace sidestep::cli
