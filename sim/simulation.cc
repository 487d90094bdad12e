#include "sidestep/sim/simulation.h"

#include <utility>

#include "sidestep/core/input_error.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/no_robot.h"
#include "sidestep/sim/robot_agreement.h"
#include "sidestep/sim/safety_of.h"
#include "sidestep/sim/simulated_robot.h"
#include "sidestep/sim/world_xml.h"

namespace sidestep::sim {
namespace {

// Times a robot's velocity limits: what a tracker that needs a limit takes for none.
constexpr double kUnlimitedSpeed = 10;

Eigen::VectorXd StartOf(const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
  if (scenario.q_start.size() > 0) return scenario.q_start;
  const auto found = robot.configurations().find(scenario.start_name);
  if (found != robot.configurations().end()) return found->second;
  throw scenarios::WrongValue(scenario, "task.start",
                              robot.name() + " has no configuration '" + scenario.start_name + "'");
}

std::vector<std::string> NamesOf(const std::vector<scenarios::MovingObstacle>& obstacles) {
  std::vector<std::string> names;
  for (const scenarios::MovingObstacle& obstacle : obstacles) names.push_back(obstacle.name);
  return names;
}

// Compiles the world. What is wrong with the robot's own file is told with its lines: those of the
// whole world are of a text that nobody wrote.
MujocoModelPtr CompileWorld(const std::string& xml, const scenarios::Scenario& scenario,
                            const robot::RobotModel& robot, const ModelFolders& models,
                            ModelStore* store) {
  const std::string name = scenario.file + ": its world";
  const std::string mjcf = RobotMjcf(scenario, models);
  MujocoModelPtr model;
  try {
    model = store == nullptr ? LoadMujocoModel(xml, name) : store->Load(xml, name);
  } catch (const InputError&) {
    CheckAgreement(robot, *LoadArmFile(mjcf), mjcf);
    throw;
  }
  CheckAgreement(robot, *model, mjcf);
  return model;
}

World MakeWorld(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                const ModelFolders& models, ModelStore* store) {
  std::string xml = BuildWorldXml(scenario, robot.mount_links(), models, store);
  MujocoModelPtr model = CompileWorld(WithoutPictures(xml), scenario, robot, models, store);
  return World(scenario, std::move(xml), std::move(model), robot.joint_names(),
               StartOf(scenario, robot));
}

World MakeWorld(const scenarios::Scenario& scenario, const ModelFolders& models) {
  std::string xml = BuildWorldXml(scenario, {}, models);
  MujocoModelPtr model = LoadMujocoModel(WithoutPictures(xml), scenario.file + ": its world");
  return World(scenario, std::move(xml), std::move(model), {}, Eigen::VectorXd());
}

}  // namespace

Simulation::Simulation(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                       const ModelFolders& models, const SensorMaker& make_sensor,
                       ModelStore* store)
    : joints_(robot.joint_names()),
      obstacles_(NamesOf(scenario.moving_obstacles)),
      world_(MakeWorld(scenario, robot, models, store)),
      truth_(world_),
      robot_(std::make_unique<SimulatedRobot>(
          robot, &world_, [this] { truth_.Observe(); },
          scenario.velocity_limits ? 1 : kUnlimitedSpeed, SafetyOf(scenario, robot))) {
  MakeSensors(scenario, make_sensor);
}

Simulation::Simulation(const scenarios::Scenario& scenario, const ModelFolders& models,
                       const SensorMaker& make_sensor)
    : obstacles_(NamesOf(scenario.moving_obstacles)),
      world_(MakeWorld(scenario, models)),
      truth_(world_),
      robot_(std::make_unique<NoRobot>(&world_)) {
  MakeSensors(scenario, make_sensor);
}

void Simulation::MakeSensors(const scenarios::Scenario& scenario, const SensorMaker& make_sensor) {
  for (const scenarios::SensorSettings& sensor : scenarios::SensorsOf(scenario)) {
    owned_sensors_.push_back(make_sensor(scenarios::WithSensor(scenario, sensor), world_));
    sensors_.push_back({NameOf(sensor), owned_sensors_.back().get()});
  }
}

}  // namespace sidestep::sim
