#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/outcome.h"
#include "sidestep/record/recording.h"
#include "sidestep/robot/robot_interface.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/robot/sensor.h"
#include "sidestep/robot/world_truth.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {

/// A robot in its world, for one episode. The pointers live as long as `owner`.
struct EpisodeWorld {
  std::shared_ptr<void> owner;
  robot::RobotInterface* robot = nullptr;
  robot::Sensor* sensor = nullptr;
  robot::WorldTruth* truth = nullptr;  ///< null on hardware: then nothing is judged by geometry
  std::string model_xml;               ///< to draw it
  std::vector<std::string> joints, obstacles;
};

/// The world that `source` holds (a Simulation, or what stands for it on hardware), kept alive by
/// it. A template, because bench knows the interfaces of robot/ alone.
template <class Source>
EpisodeWorld MakeEpisodeWorld(std::shared_ptr<Source> source) {
  EpisodeWorld world;
  world.robot = &source->robot();
  world.sensor = &source->sensor();
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

/// How the scenario's model of the world is made, fed from `world`. Its fields hold no reference to
/// either and tell distances up to `max_distance_m`.
sdf::WorldModelOptions MakeWorldModelOptions(const scenarios::Scenario& scenario,
                                             double max_distance_m, const EpisodeWorld& world);

/// Is shown the field of each planning cycle as the planner saw it, made at time `t`, and the
/// truth, which is null on hardware. Only wall-clock figures may depend on it.
using FieldObserver =
    std::function<void(EpisodeTime t, std::shared_ptr<const sdf::DistanceField> field,
                       const robot::WorldTruth* truth)>;

/// CPU seconds by stage ("sense", "map", "segment", "track", "predict", "optimise", "cycle"), one
/// entry a planning cycle. What sensing and mapping cost since the cycle before is counted in.
using StageTimes = std::map<std::string, std::vector<double>>;

struct EpisodeResult {
  Outcome outcome = Outcome::kTimeout;
  /// Why it was aborted, or why the robot was never given a plan; else empty. In the recording's
  /// header as "reason", beside "outcome".
  std::string reason;
  record::Recording recording;  ///< its metrics are filled
  StageTimes times;             ///< has every stage, even where there was no planning cycle
  double wall_s = 0;            ///< of the whole episode
};

/// Runs one closed loop: sense, predict, re-plan, splice, move, until 0.5 s after the goal is
/// reached or twice the horizon. Everything but `times` and `wall_s` is a function of the scenario
/// and the build. A planning cycle begins at multiples of 1 / replan_rate and takes
/// scenario.latency_s of episode time; the next one begins at the first multiple after that.
///
/// What is thrown on the way (by the robot, the sensor, the planner, the observer ...) ends the
/// episode as aborted: what was recorded until then is the result. However it ends, the robot is
/// told to hold.
/// @param scenario with its task resolved (bench/resolve.h).
/// @throws std::invalid_argument for words of the scenario that no module knows, and whatever
/// `make_world` throws: then there was no episode.
EpisodeResult RunEpisode(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                         const WorldFactory& make_world, const FieldObserver& observe_field = {});

/// For whom a part of an episode is of no use. @throws std::runtime_error, with the reason, if it
/// was aborted.
void RequireWhole(const EpisodeResult& result);

}  // namespace sidestep::bench
