#include "sidestep/bench/reproduce/open_loop_experiment.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace sidestep::bench {
namespace {

// Written out, not summed up: 1.0 + 7 * 0.1 is not 1.7, and last bits decide which cell the box
// falls into.
const std::vector<double> kWamSpeeds = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
const std::vector<double> kHsrSpeeds = {1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0};

GridSpec Cube(int cells) { return {Eigen::Vector3d(-1, -1, -1), 0.04, {cells, cells, cells}}; }

// A WAM between a table and a cabinet; a pillar drives in front of it.
OpenLoopExperiment WamSinglePillar() {
  OpenLoopExperiment e;
  e.name = "wam_single_pillar";
  e.published_robot = e.own_robot = "wam/robot.yaml";
  e.grid = Cube(64);
  e.static_boxes = {
      {{0.20, 0.70, -0.20}, {1.40, 0.60, 0.05}},   // table top
      {{-0.45, 0.45, -0.60}, {0.1, 0.1, 0.8}},     // its legs
      {{0.85, 0.45, -0.60}, {0.1, 0.1, 0.8}},      //
      {{-0.45, 0.95, -0.60}, {0.1, 0.1, 0.8}},     //
      {{0.85, 0.95, -0.60}, {0.1, 0.1, 0.8}},      //
      {{1.00, 0.40, -0.05}, {0.60, 0.05, 1.90}},   // sides of the cabinet
      {{1.00, -0.60, -0.05}, {0.60, 0.05, 1.90}},  //
      {{0.50, 0.40, -0.05}, {0.40, 0.05, 1.90}},   // partition
      {{1.00, -0.10, 0.90}, {0.60, 1.00, 0.05}},   // shelves
      {{1.00, -0.10, 0.40}, {0.60, 1.00, 0.05}},   //
      {{1.00, -0.10, -0.10}, {0.60, 1.00, 0.05}},  //
      {{1.00, -0.10, -0.60}, {0.60, 1.00, 0.05}},  //
  };
  e.moving_box = {{0.55, -0.95, -0.05}, {0.15, 0.15, 1.9}};
  e.direction = {-0.2726, 0.9621, 0};
  e.stop_s = 2;
  e.speeds_m_s = kWamSpeeds;
  e.excluded_speeds_m_s = {0.5};
  e.pairs = {{"pose1", "pose3"}, {"pose1", "pose4"}, {"pose1", "pose5"}, {"pose2", "pose3"},
             {"pose2", "pose4"}, {"pose2", "pose5"}, {"pose3", "pose4"}};
  e.sigma_obs = 0.2;
  e.epsilon_m = 0.2;
  e.num_interpolated = 19;
  return e;
}

// A Panda on a table reaches across the gap to another; an HSR drives through the gap.
OpenLoopExperiment PandaHsr() {
  OpenLoopExperiment e;
  e.name = "panda_hsr";
  e.published_robot = "panda/published.yaml";
  e.own_robot = "panda/robot.yaml";
  e.X_WB = Pose(Eigen::Quaterniond::Identity(), {0, 0, 0.4});
  e.grid = Cube(96);
  e.static_boxes = {{{-0.31, 0, 0.2}, {0.80, 1.2, 0.4}}, {{1.05, 0, 0.2}, {0.80, 1.2, 0.4}}};
  e.moving_box = {{0.4, 2.0, 0.6}, {0.48, 0.55, 1.2}};
  e.direction = {0, -1, 0};
  e.stop_s = 3;
  e.speeds_m_s = kHsrSpeeds;
  const std::array starts = {"ready", "right_ready", "pickup_right", "pickup_left"};
  const std::array goals = {"table_forward",      "table_right",     "table_left",
                            "table_forward_horz", "table_left_horz", "table_right_horz"};
  for (const char* start : starts) {
    for (const char* goal : goals) e.pairs.emplace_back(start, goal);
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

PublishedBox OpenLoopExperiment::MovingBoxAt(double speed_m_s, int step) const {
  return MovingBoxAtTime(speed_m_s, step * step_s);
}

PublishedBox OpenLoopExperiment::MovingBoxAtTime(double speed_m_s, double t_s) const {
  // In this order: the authors' rounding decides ties.
  const Eigen::Vector3d velocity_m_s = speed_m_s * direction;
  return {moving_box.center_m + std::min(t_s, stop_s) * velocity_m_s, moving_box.size_m};
}

std::vector<std::string> OpenLoopExperimentNames() { return {"panda_hsr", "wam_single_pillar"}; }

OpenLoopExperiment MakeOpenLoopExperiment(const std::string& name) {
  if (name == "panda_hsr") return PandaHsr();
  if (name == "wam_single_pillar") return WamSinglePillar();
  throw std::invalid_argument("unknown experiment '" + name + "'");
}

}  // namespace sidestep::bench
