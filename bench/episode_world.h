#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/robot/robot_interface.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/robot/sensor.h"
#include "sidestep/robot/world_truth.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// A robot in its world, for one episode. The pointers live as long as `owner`.
struct EpisodeWorld {
  std::shared_ptr<void> owner;
  robot::RobotInterface* robot = nullptr;
  std::vector<robot::NamedSensor> sensors;
  robot::WorldTruth* truth = nullptr;  ///< null on hardware: then nothing is judged by geometry
  std::string model_xml;               ///< to draw it
  std::vector<std::string> joints, obstacles;
  std::map<std::string, std::string> facts;  ///< for the header of a recording of it
};

/// The world that `source` holds (a Simulation, or what stands for it on hardware), kept alive by
/// it. A template, because bench knows the interfaces of robot/ alone.
template <class Source>
EpisodeWorld MakeEpisodeWorld(std::shared_ptr<Source> source) {
  EpisodeWorld world;
  world.robot = &source->robot();
  world.sensors = source->sensors();
  world.truth = &source->truth();
  world.model_xml = source->model_xml();
  world.joints = source->joints();
  world.obstacles = source->obstacles();
  world.owner = std::move(source);
  return world;
}

/// Makes the world of a scenario; simulation and hardware each have one.
using WorldFactory =
    std::function<EpisodeWorld(const scenarios::Scenario&, const robot::RobotModel&)>;

}  // namespace sidestep::bench
