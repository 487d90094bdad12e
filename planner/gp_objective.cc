#include "sidestep/planner/gp_objective.h"

#include <algorithm>

#include "sidestep/robot/tolerance_scale.h"

namespace sidestep::planner {
namespace {

// Weights of the limit costs [1/rad, s/rad, s^2/rad]. In the walkway scene at 1.2 to 2.0 m/s plans
// exceed what they are drawn to by at most 2 % of it; ten times the weights take two to three times
// the iterations for the same plans.
constexpr double kPositionWeight = 1000;
constexpr double kVelocityWeight = 30;
constexpr double kAccelerationWeight = 5;

// Soft costs give way a little: they begin this far inside the robot's position limits, and at this
// share of the velocity and the acceleration that are asked for.
constexpr double kPositionMargin_rad = 0.02;
constexpr double kDynamicShare = 0.97;

}  // namespace

SoftLimits MakeSoftLimits(const robot::RobotModel& robot, const Eigen::VectorXd& q_start,
                          const Eigen::VectorXd& q_goal, const LimitWeights& weights,
                          double velocity_scale, double acceleration_scale) {
  const int n = robot.num_joints();
  const Eigen::VectorXd margin = kPositionMargin_rad * robot::ToleranceScale(robot);
  SoftLimits soft{weights, Eigen::VectorXd(2 * n), Eigen::VectorXd(2 * n), Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    const robot::JointLimits& limits = robot.limits()[static_cast<std::size_t>(i)];
    soft.lower(i) = std::min({limits.q_min + margin(i), q_start(i), q_goal(i)});
    soft.upper(i) = std::max({limits.q_max - margin(i), q_start(i), q_goal(i)});
    soft.upper(n + i) = velocity_scale * limits.v_max;
    soft.lower(n + i) = -soft.upper(n + i);
    soft.a_max(i) = acceleration_scale * limits.a_max;
  }
  return soft;
}

GpProblemOptions ObjectiveOf(const PlannerSettings& settings, const GpSettings& gp) {
  GpProblemOptions options;
  options.epsilon_m = settings.epsilon_m;
  options.sigma_obs = gp.sigma_obs;
  options.num_interpolated = gp.num_interpolated;
  options.qc = gp.qc;
  options.sigma_goal = gp.sigma_goal;
  options.self_epsilon_m = kSelfEpsilon_m;
  return options;
}

SoftLimits SoftLimitsOf(const robot::RobotModel& robot, const Eigen::VectorXd& q_start,
                        const Eigen::VectorXd& q_goal, const PlannerSettings& settings,
                        double stiffness) {
  LimitWeights weights;
  if (settings.position_limits) weights.position = stiffness * kPositionWeight;
  if (settings.velocity_limits) weights.velocity = stiffness * kVelocityWeight;
  if (settings.acceleration_limits) weights.acceleration = stiffness * kAccelerationWeight;
  return MakeSoftLimits(robot, q_start, q_goal, weights, kDynamicShare * settings.velocity_scale,
                        kDynamicShare * settings.acceleration_scale);
}

}  // namespace sidestep::planner
