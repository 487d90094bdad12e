#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/time.h"

namespace sidestep {

/// A thing that moves, as it was seen last: a box around it, with its edges and corners rounded.
struct ObstacleState {
  int id = 0;
  EpisodeTime t;                                             ///< of the capture
  Pose X_WO;                                                 ///< O is the centre of the box
  Eigen::Vector3d half_extents_m = Eigen::Vector3d::Zero();  ///< of the box
  double radius_m = 0;                                       ///< by which the box is grown
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();             ///< [m/s] of its centre
  double speed_sigma_m_s = 0;                                ///< of the error of its speed
  bool has_left = false;                                     ///< where robots work, when seen last
};

/// What is known of everything that moves.
struct ObstacleReport {
  EpisodeTime t;  ///< capture of the newest scan that was accepted, whether or not it saw anything
  std::vector<ObstacleState> obstacles;
};

}  // namespace sidestep
