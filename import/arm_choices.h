#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sidestep::imports {

/// What the file of a robot leaves open.
struct ArmChoices {
  std::string name;                   ///< of the robot
  std::string base, tip;              ///< links; empty: found as ArmOfTree says
  std::map<std::string, double> fix;  ///< joints that are held where they are told [rad, m]
  std::vector<std::string> package_paths;
  bool cylinders_as_capsules = false;
  bool visuals_as_collisions = false;  ///< of links without a collision
  bool repair_inertia = false;
  bool turn_up_axis = true;      ///< of COLLADA meshes
  int max_hull_vertices = 200;   ///< of a mesh's hull
  std::optional<double> v_max;   ///< of joints of which no greatest speed is known: rad/s, m/s
  std::optional<double> ramp_s;  ///< in which a joint comes to its greatest speed
};

}  // namespace sidestep::imports
