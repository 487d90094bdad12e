#include "sim/simulation.h"

#include "core/input_error.h"
#include "sim/no_robot.h"
#include "sim/sensors.h"
#include "sim/simulated_robot.h"
#include "sim/world_xml.h"

namespace sidestep {
namespace {

// Times a robot's velocity limits: what a tracker that needs a limit takes for none.
constexpr double kUnlimited = 10;

Eigen::VectorXd StartOf(const Scenario& scenario, const RobotModel& robot) {
  if (scenario.q_start.size() > 0) return scenario.q_start;
  const auto found = robot.configurations().find(scenario.start_name);
  if (found != robot.configurations().end()) return found->second;
  throw WrongValue(scenario, "task.start",
                   robot.name() + " has no configuration '" + scenario.start_name + "'");
}

std::vector<std::string> NamesOf(const std::vector<MovingObstacle>& obstacles) {
  std::vector<std::string> names;
  for (const MovingObstacle& obstacle : obstacles) names.push_back(obstacle.name);
  return names;
}

}  // namespace

Simulation::Simulation(const Scenario& scenario, const RobotModel& robot,
                       const std::string& models_dir)
    : model_xml_(BuildWorldXml(scenario, robot.mount_links(), models_dir)),
      joints_(robot.joint_names()),
      obstacles_(NamesOf(scenario.moving_obstacles)),
      world_(scenario, model_xml_, joints_, StartOf(scenario, robot)),
      truth_(world_),
      robot_(std::make_unique<SimulatedRobot>(
          robot, &world_, [this] { truth_.Observe(); }, scenario.velocity_limits ? 1 : kUnlimited)),
      sensor_(MakeSensor(scenario, world_)) {}

Simulation::Simulation(const Scenario& scenario, const std::string& models_dir)
    : model_xml_(BuildWorldXml(scenario, {}, models_dir)),
      obstacles_(NamesOf(scenario.moving_obstacles)),
      world_(scenario, model_xml_, {}, Eigen::VectorXd()),
      truth_(world_),
      robot_(std::make_unique<NoRobot>(&world_)),
      sensor_(MakeSensor(scenario, world_)) {}

}  // namespace sidestep
