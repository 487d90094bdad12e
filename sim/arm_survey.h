#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <vector>

#include "sidestep/robot/arm_description.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::sim {

/// What is found of an arm by trying it: which links touch, and how its joints are to be held.
struct ArmSurvey {
  /// Pairs of links that touch each other, as MuJoCo sees it, at nearly all configurations, or at
  /// some. MuJoCo looks for no contact between links that one joint joins.
  std::vector<robot::LinkPair> always, sometimes;
  std::vector<Eigen::VectorXd> free;  ///< the candidates without self-contact, in their order
  /// Of each coordinate, the share that was asked for of the greatest inertia that it moves alone:
  /// what the rotor of its motor may count behind a gear, of which a URDF says nothing; 0 for one
  /// that has an armature.
  Eigen::VectorXd armature;
  /// Gains of the joint impedance [N m/rad, N m s/rad]: critically damped at the bandwidth by the
  /// greatest inertia that each joint moves alone; the damping more where the others would make it
  /// ring, the bandwidth less than asked for where a command each millisecond would not be stable.
  Eigen::VectorXd stiffness, damping;
  double bandwidth_rad_s = 0;
};

struct SurveySettings {
  std::vector<Eigen::VectorXd> configurations;  ///< where it is tried
  std::vector<Eigen::VectorXd> candidates;      ///< for where it may begin
  double bandwidth_rad_s = 50;
  double armature_share = 0.1;
};

/// @param model the MJCF of `arm`, compiled alone.
ArmSurvey SurveyArm(const mjModel& model, const robot::ArmDescription& arm,
                    const SurveySettings& settings);

}  // namespace sidestep::sim
