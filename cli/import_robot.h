#pragma once

#include <string>

#include "sidestep/import/arm_choices.h"
#include "sidestep/import/link_spheres.h"

namespace sidestep::cli {

/// What `sidestep import` is asked for.
struct RobotImport {
  std::string file;  ///< URDF, or MJCF if its name ends in .xml
  std::string out;   ///< the robot's folder
  imports::ArmChoices choices;
  bool overwrite = false;  ///< a robot that is there
  imports::SphereRequest spheres;
  double bandwidth_rad_s = 50;
  double armature_share = 0.1;
};

/// Makes the robot's folder, and says what became of it. @throws InputError.
void ImportRobot(const RobotImport& request);

}  // namespace sidestep::cli
