#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sidestep/bench/episode_world.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/hardware/fci_driver.h"
#include "sidestep/hardware/panda_robot.h"
#include "sidestep/sim/sensors.h"

namespace sidestep::cli {

/// Connects to the Panda at `address` and sets it up. @throws InputError, blaming --robot, if
/// nobody answers there, or it is not to be moved as it is (which the operator's log keeps).
std::unique_ptr<hardware::PandaRobot> ConnectReadyPanda(const std::string& address,
                                                        const robot::RobotModel& robot,
                                                        const hardware::PandaOptions& options);

/// Why an arm at `q` is not where the scenario's task starts, if it is not.
std::optional<std::string> WhyNotAtStart(const Eigen::VectorXd& q,
                                         const scenarios::Scenario& scenario);

/// A robot at the end of a wire, and what is around it.
struct HardwareSite {
  std::string address;  ///< of the robot
  sim::SensorMaker make_sensor;
  /// Of a camera that sees what is really around the robot. Empty: the scenario's obstacles move as
  /// they are prescribed ("virtual obstacles"), and the sensor sees those.
  std::string camera;
};

/// Makes worlds in which such a Panda stands; nobody knows whether the arm touches anything real.
/// Each world connects anew.
/// The factory throws InputError if nobody answers, or the robot is not where the task starts.
bench::WorldFactory HardwareWorlds(const DataPaths& paths, const HardwareSite& site,
                                   const hardware::PandaOptions& options);

/// The same with a robot that is only looked at (hardware/standing_robot.h), wherever it is.
/// @param driver of the robot, for one world.
bench::WorldFactory StandingWorlds(const DataPaths& paths, const HardwareSite& site,
                                   std::unique_ptr<hardware::FciDriver> driver);

}  // namespace sidestep::cli
