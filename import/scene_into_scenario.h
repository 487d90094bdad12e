#pragma once

#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/import/moveit_files.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::imports {

/// Puts what stands in a scene into a scenario, with the robot's base where it is: meshes centred
/// on their frames, names that are none of the robot's links, the robot mounted on what its mount
/// spheres are in. Without a floor of the scene, the floor is below all things and all that the arm
/// can reach.
void PutInto(const ImportedScene& scene, const robot::RobotModel& robot,
             scenarios::Scenario& scenario);

/// Puts start and goal of a request into a scenario. Joints are found by their names, which may
/// have a prefix with a _ in one of the two. A goal that is a pose becomes a configuration that is
/// free in the scenario; a start that is left out becomes a named configuration that is free.
/// @return what was left out, a line each. @throws InputError for a joint that is missing, a link
/// that is not the robot's, a pose without a free configuration.
std::vector<std::string> PutInto(const ImportedRequest& request, const robot::RobotModel& robot,
                                 RandomStream& random, scenarios::Scenario& scenario);

}  // namespace sidestep::imports
