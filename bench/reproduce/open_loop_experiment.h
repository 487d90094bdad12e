#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/shape.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// A published open-loop experiment: one moving box, many pairs of start and goal, many speeds. Its
/// scene is a shipped scenario; what only the protocol knows is added here. All figures are those
/// of the authors' code, ori-drs/gpmp2 (BSD-3-Clause), of Finean, Merkt & Havoutis (ICAPS 2021);
/// the paper's text differs in places (docs/paper.md).
struct OpenLoopExperiment {
  std::string name;
  /// A file below models/ with the robot's figures as published; the product's own are those of
  /// scene.robot.
  std::string published_robot;
  /// Robot and base, grid, horizon and step, boxes that stand and the one that moves. Its planner,
  /// speed, task and floor are not used.
  scenarios::Scenario scene;

  /// The moving box's velocity is speed * direction. Not the scene's: the authors' vector is 20 ppm
  /// short of a unit, and a scenario's direction has unit length.
  Eigen::Vector3d direction;
  std::vector<double> speeds_m_s;
  /// Speeds that the publication leaves out: the box comes to rest where the arm has to go.
  std::vector<double> excluded_speeds_m_s;

  /// Names of the robot's configurations; pair p of the published tables is pairs[p - 1].
  std::vector<std::pair<std::string, std::string>> pairs;

  double qc = 1;
  double sigma_prior = 1e-4;  ///< of start, goal and pinned states
  double sigma_obs = 0;
  double epsilon_m = 0;
  int num_interpolated = 0;

  int num_states() const;
  const Box& moving_box() const { return std::get<Box>(scene.moving_obstacles.front().shape); }
  /// Where the moving box is at a time >= 0.
  Eigen::Vector3d MovingBoxCenter(double speed_m_s, double t_s) const;
};

/// "panda_hsr", "wam_single_pillar".
std::vector<std::string> OpenLoopExperimentNames();
/// @param scenarios_dir the folder of scenarios.
/// @throws std::invalid_argument for another name; InputError as LoadBoxScene.
OpenLoopExperiment MakeOpenLoopExperiment(const std::string& name,
                                          const std::string& scenarios_dir);

}  // namespace sidestep::bench
