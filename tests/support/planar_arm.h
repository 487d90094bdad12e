#pragma once

#include "sidestep/robot/robot_model.h"

namespace sidestep {

/// A real, tiny robot: two links of 0.5 m in the plane z = 0; see planar_arm.yaml.
inline robot::RobotModel MakePlanarArm() {
  return robot::RobotModel::FromFile(SIDESTEP_SOURCE_DIR "/tests/support/planar_arm.yaml", Pose());
}

}  // namespace sidestep
