#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim::fci {

/// A Panda on the floor and nothing else.
scenarios::Scenario PandaAlone();

/// The world of a scenario with its arm at q_start. @param robot the scenario's, at its X_WB.
/// @throws InputError as Simulation does.
std::unique_ptr<World> MakePandaWorld(const scenarios::Scenario& scenario,
                                      const robot::RobotModel& robot, const ModelFolders& models,
                                      const Eigen::VectorXd& q_start);

}  // namespace sidestep::sim::fci
