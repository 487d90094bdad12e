#pragma once

#include <string>
#include <vector>

#include "sidestep/cli/data_paths.h"
#include "sidestep/import/draft_scenario.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// A scenario that is being written, and its robot.
struct Draft {
  scenarios::Scenario scenario;
  robot::RobotModel robot;
};

/// Begins the scenario that is to become the file `out` ("" for standard output): the robot of that
/// name, or in that folder if it has a /, with its base at `X_WB`; nothing around it.
/// @throws InputError.
Draft BeginDraft(const std::string& robot, const Pose& X_WB, const std::string& out,
                 const DataPaths& paths);

/// How high the robot's foot stands, for the floor to be there; -infinity for a robot without
/// solids.
double FootHeight(const Draft& draft, const DataPaths& paths);

/// Whether the arm touches nothing at a configuration, itself neither, as the simulator judges it.
imports::IsGood TouchesNothing(const Draft& draft, const DataPaths& paths);

/// Refuses a file that is there: it may be a person's work. @throws InputError, of `option`.
void CheckIsNew(const std::string& out, const std::string& option = "--out");

/// How to run the scenario, for its head: `sidestep run FILE --models DIR`.
std::string HowToRun(const std::string& out, const std::vector<std::string>& models);

}  // namespace sidestep::cli
