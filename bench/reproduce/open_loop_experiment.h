#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/pose.h"

namespace sidestep::bench {

/// An axis-aligned box.
struct PublishedBox {
  Eigen::Vector3d center_m, size_m;
};

/// A published open-loop experiment: one moving box, many pairs of start and goal, many speeds. All
/// figures are those of the authors' code, ori-drs/gpmp2 (BSD-3-Clause), of Finean, Merkt &
/// Havoutis (ICAPS 2021); the paper's text differs in places (docs/paper.md).
struct OpenLoopExperiment {
  std::string name;
  /// Robot files below models/: with the figures as published, and as the product has them.
  std::string published_robot, own_robot;
  Pose X_WB;
  GridSpec grid;

  std::vector<PublishedBox> static_boxes;
  PublishedBox moving_box;    ///< at time 0
  Eigen::Vector3d direction;  ///< its velocity is speed * direction
  double stop_s = 0;          ///< when it stops
  std::vector<double> speeds_m_s;
  /// Speeds that the publication leaves out: the box comes to rest where the arm has to go.
  std::vector<double> excluded_speeds_m_s;

  /// Names of the robot's configurations; pair p of the published tables is pairs[p - 1].
  std::vector<std::pair<std::string, std::string>> pairs;

  double step_s = 0.1;
  int num_states = 31;
  double qc = 1;
  double sigma_prior = 1e-4;  ///< of start, goal and pinned states
  double sigma_obs = 0;
  double epsilon_m = 0;
  int num_interpolated = 0;

  /// Where the moving box is, at a step k >= 0 or a time >= 0.
  PublishedBox MovingBoxAt(double speed_m_s, int step) const;
  PublishedBox MovingBoxAtTime(double speed_m_s, double t_s) const;
};

/// "panda_hsr", "wam_single_pillar".
std::vector<std::string> OpenLoopExperimentNames();
/// @throws std::invalid_argument for another name.
OpenLoopExperiment MakeOpenLoopExperiment(const std::string& name);

}  // namespace sidestep::bench
