#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sidestep/robot/robot_interface.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/robot/sensor.h"
#include "sidestep/robot/world_truth.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/model_store.h"
#include "sidestep/sim/sensors.h"
#include "sidestep/sim/simulated_truth.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// Everything simulated of one episode: the world, the robot that moves in it, the sensors that see
/// it, and the truth about it, at time 0. One thread at a time; any number of simulations in one
/// process do not influence each other.
class Simulation {
 public:
  /// @param robot the scenario's, with its base at scenario.X_WB.
  /// @throws InputError for a robot whose robot.yaml and MJCF do not agree (sim/robot_agreement.h),
  ///   model files that do not fit, a start that the robot does not have, or
  ///   an unknown sensor.
  /// @param make_sensor for who has more sensors than these (sim/sensors.h).
  /// @param store of the models of other simulations, to which its own is added; may be null.
  Simulation(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
             const ModelFolders& models, const SensorMaker& make_sensor = MakeSensor,
             ModelStore* store = nullptr);
  /// The world of a scenario without a robot; robot() is then only its clock (sim/no_robot.h).
  Simulation(const scenarios::Scenario& scenario, const ModelFolders& models,
             const SensorMaker& make_sensor = MakeSensor);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  robot::RobotInterface& robot() { return *robot_; }
  robot::Sensor& sensor() { return *sensors_.front().sensor; }  ///< the first, or only one
  const std::vector<robot::NamedSensor>& sensors() { return sensors_; }
  robot::WorldTruth& truth() { return truth_; }
  const World& world() const { return world_; }

  const std::string& model_xml() const { return world_.xml(); }       ///< MJCF of the whole world
  const std::vector<std::string>& joints() const { return joints_; }  ///< as in the MJCF
  const std::vector<std::string>& obstacles() const { return obstacles_; }  ///< mocap bodies

 private:
  void MakeSensors(const scenarios::Scenario& scenario, const SensorMaker& make_sensor);

  std::vector<std::string> joints_, obstacles_;
  World world_;
  SimulatedTruth truth_;
  std::unique_ptr<robot::RobotInterface> robot_;
  std::vector<std::unique_ptr<robot::Sensor>> owned_sensors_;
  std::vector<robot::NamedSensor> sensors_;
};

}  // namespace sidestep::sim
