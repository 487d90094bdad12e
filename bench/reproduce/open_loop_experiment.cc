#include "sidestep/bench/reproduce/open_loop_experiment.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sidestep/bench/reproduce/field_scene.h"

namespace sidestep::bench {
namespace {

// A WAM between a table and a cabinet; a pillar drives in front of it.
OpenLoopExperiment WamSinglePillar(const std::string& scenarios_dir) {
  const std::string path = scenarios_dir + "/wam_single_pillar.yaml";
  OpenLoopExperiment e;
  e.published_robot = "wam/robot.yaml";
  const auto choices = scenarios::ScenarioChoices(path);
  for (const std::string& pair : choices.at("pair")) {
    e.scene = LoadBoxScene(path, {{"pair", pair}});
    e.pairs.emplace_back(e.scene.start_name, e.scene.goal_name);
  }
  std::erase_if(e.scene.static_obstacles,
                [](const scenarios::StaticObstacle& box) { return box.name == "stand"; });
  e.direction = {-0.2726, 0.9621, 0};
  // Written out, not summed up: 1.0 + 7 * 0.1 is not 1.7, and last bits decide which cell the box
  // falls into.
  e.speeds_m_s = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
  e.excluded_speeds_m_s = {0.5};
  e.sigma_obs = 0.2;
  e.epsilon_m = 0.2;
  e.num_interpolated = 19;
  return e;
}

// A Panda on a table reaches across the gap to another; an HSR drives through the gap.
OpenLoopExperiment PandaHsr(const std::string& scenarios_dir) {
  OpenLoopExperiment e;
  e.published_robot = "panda/published.yaml";
  e.scene = LoadBoxScene(scenarios_dir + "/hsr_walkway.yaml");
  e.direction = {0, -1, 0};
  e.speeds_m_s = {1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0};
  for (const char* start : {"ready", "right_ready", "pickup_right", "pickup_left"}) {
    for (const char* goal : {"table_forward", "table_right", "table_left", "table_forward_horz",
                             "table_left_horz", "table_right_horz"}) {
      e.pairs.emplace_back(start, goal);
    }
  }
  const std::size_t forward = e.pairs.size();
  for (std::size_t p = 0; p < forward; ++p) {
    e.pairs.emplace_back(e.pairs[p].second, e.pairs[p].first);
  }
  e.sigma_obs = 0.05;
  e.epsilon_m = 0.3;
  e.num_interpolated = 0;
  return e;
}

}  // namespace

int OpenLoopExperiment::num_states() const {
  return static_cast<int>(std::lround(scene.horizon_s / scene.step_s)) + 1;
}

Eigen::Vector3d OpenLoopExperiment::MovingBoxCenter(double speed_m_s, double t_s) const {
  const auto& motion = std::get<scenarios::LinearMotion>(scene.moving_obstacles.front().motion);
  // In this order: the authors' rounding decides ties.
  const Eigen::Vector3d velocity_m_s = speed_m_s * direction;
  return motion.start_m + std::min(t_s, motion.stop_at_s) * velocity_m_s;
}

std::vector<std::string> OpenLoopExperimentNames() { return {"panda_hsr", "wam_single_pillar"}; }

OpenLoopExperiment MakeOpenLoopExperiment(const std::string& name,
                                          const std::string& scenarios_dir) {
  if (name != "panda_hsr" && name != "wam_single_pillar") {
    throw std::invalid_argument("unknown experiment '" + name + "'");
  }
  OpenLoopExperiment experiment =
      name == "panda_hsr" ? PandaHsr(scenarios_dir) : WamSinglePillar(scenarios_dir);
  experiment.name = name;
  return experiment;
}

}  // namespace sidestep::bench
