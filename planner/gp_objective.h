#pragma once

#include <Eigen/Core>
#include <optional>

#include "sidestep/planner/gp_settings.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// Links are kept so far apart: spheres leave gaps between them and the shapes (docs/robots.md).
inline constexpr double kSelfEpsilon_m = 0.05;

/// The objective of a Gaussian-process planner. Units as in the cost functions of planner/costs/.
struct GpProblemOptions {
  double epsilon_m = 0.2;
  double sigma_obs = 0.05;
  int num_interpolated = 1;  ///< obstacle costs inside each interval, evenly spaced
  double qc = 1;
  double sigma_goal = 1e-4;
  /// Without it, fixed states are constants. With it they are free, and priors of this sigma draw
  /// state 0 to the request's start and the others to the initial motion: the published
  /// formulation.
  std::optional<double> sigma_fixed = std::nullopt;
  /// Links of the robot's self_collision() nearer to each other than this are pushed apart, with
  /// sigma_obs. The published formulation has none.
  std::optional<double> self_epsilon_m = std::nullopt;
  /// Fewer residuals to the same end: see obstacle_hinge.h.
  bool condensed = false;
};

/// Weights of the limit costs [1/rad, s/rad, s^2/rad]; 0 leaves a kind out.
struct LimitWeights {
  double position = 0, velocity = 0, acceleration = 0;
};

/// What the limit costs of a request keep every free state and interval within: the given fractions
/// of the robot's velocity and acceleration limits, and 0.02 rad within its position limits unless
/// start or goal lie closer.
struct SoftLimits {
  LimitWeights weights;
  Eigen::VectorXd lower, upper;  ///< 2n: of (q, v)
  Eigen::VectorXd a_max;         ///< n
};
SoftLimits MakeSoftLimits(const robot::RobotModel& robot, const Eigen::VectorXd& q_start,
                          const Eigen::VectorXd& q_goal, const LimitWeights& weights,
                          double velocity_scale, double acceleration_scale);

/// What planners make of their settings, whatever solves it: links are kept kSelfEpsilon_m apart,
/// and a motion to 0.97 of the velocities and accelerations that are asked for, since soft limits
/// give way a little.
GpProblemOptions ObjectiveOf(const PlannerSettings& settings, const GpSettings& gp);
/// @param stiffness weights are so many times the usual.
SoftLimits SoftLimitsOf(const robot::RobotModel& robot, const Eigen::VectorXd& q_start,
                        const Eigen::VectorXd& q_goal, const PlannerSettings& settings,
                        double stiffness);

}  // namespace sidestep::planner
