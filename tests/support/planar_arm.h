#pragma once

#include "robot/robot_model.h"

namespace sidestep {

/// A real, tiny robot: two links of 0.5 m in the plane z = 0; see planar_arm.yaml.
inline RobotModel MakePlanarArm() {
  return RobotModel::FromFile(SIDESTEP_SOURCE_DIR "/tests/support/planar_arm.yaml", Pose());
}

}  // namespace sidestep
