#include "sidestep/planner/free_goal.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstddef>

#include "sidestep/core/trajectory.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/costs/obstacle_hinge.h"
#include "sidestep/planner/gp_objective.h"

namespace sidestep::planner {
namespace {

constexpr double kMarginShare = 0.5;  // of the safety margin, to be kept while waiting
constexpr double kPulls_rad[] = {0.03, 0.1, 0.3, 1, 3};  // to the goal, as a standard deviation
constexpr double kHingeSigma_m = 0.05;
constexpr int kMostSteps = 20;  // with each pull
constexpr double kLongestStep_rad = 0.1;
constexpr double kStill_rad = 1e-4;

double LeastClearance(const ClearanceMeter& meter, const sdf::DistanceField& field,
                      const Eigen::VectorXd& q, EpisodeTime t) {
  const Trajectory there = {Eigen::VectorXd::Zero(1), q, Eigen::VectorXd::Zero(q.size())};
  return meter.Measure(field, there, t, t, t).least_m;
}

}  // namespace

bool IsBlocked(const robot::RobotModel& robot, const sdf::DistanceField& field,
               const Eigen::VectorXd& q, EpisodeTime t) {
  return LeastClearance(ClearanceMeter(robot), field, q, t) <= 0;
}

std::optional<Eigen::VectorXd> FindFreeGoal(const robot::RobotModel& robot,
                                            const sdf::DistanceField& field,
                                            const PlannerSettings& settings,
                                            const Eigen::VectorXd& q_goal, EpisodeTime t) {
  const Eigen::Index n = q_goal.size();
  ObstacleHinge hinge(robot, field, settings.epsilon_m, kHingeSigma_m, kSelfEpsilon_m);
  const ClearanceMeter meter(robot);
  Eigen::VectorXd q = q_goal;
  for (const double pull_rad : kPulls_rad) {
    const double information = 1 / (pull_rad * pull_rad);
    for (int i = 0; i < kMostSteps; ++i) {
      // A Gauss-Newton step, of a length for which the field is still what it was.
      hinge.Evaluate(q, t, /*with_jacobian=*/true);
      const auto& J = hinge.jacobian();
      const Eigen::MatrixXd H = J.transpose() * J + information * Eigen::MatrixXd::Identity(n, n);
      const Eigen::VectorXd gradient = J.transpose() * hinge.hinges() + information * (q - q_goal);
      Eigen::VectorXd step = -H.ldlt().solve(gradient);
      step *= std::min(1.0, kLongestStep_rad / std::max(step.cwiseAbs().maxCoeff(), kStill_rad));
      for (Eigen::Index j = 0; j < n; ++j) {
        const robot::JointLimits& joint = robot.limits()[static_cast<std::size_t>(j)];
        const double next = std::clamp(q(j) + step(j), std::min(joint.q_min, q_goal(j)),
                                       std::max(joint.q_max, q_goal(j)));
        step(j) = next - q(j);
        q(j) = next;
      }
      if (step.cwiseAbs().maxCoeff() < kStill_rad) break;
    }
    const double clearance_m = LeastClearance(meter, field, q, t);
    if (clearance_m > 0 && clearance_m >= kMarginShare * settings.epsilon_m) return q;
  }
  return std::nullopt;
}

}  // namespace sidestep::planner
