#pragma once

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "sidestep/core/trajectory.h"
#include "sidestep/planner/costs/obstacle_hinge.h"
#include "sidestep/planner/planner.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

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
  std::optional<double> sigma_fixed;
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

/// A plan request as a least-squares problem, apart from any solver: one block of 2n parameters
/// (q, v) a support state, one residual block a configuration. Unless condensed, this is the plain
/// formulation that faster ones must match in cost and gradient.
///
/// Its cost functions share buffers: evaluate it in one thread.
class GpProblem {
 public:
  /// `robot` and the request's field are borrowed. `initial` stands on the request's grid and
  /// holds its fixed states; see MakeDirectMotion and MakeWarmStart.
  GpProblem(const robot::RobotModel& robot, const PlanRequest& request, const Trajectory& initial,
            const GpProblemOptions& options);

  /// Adds costs that keep every free state and interval within the given fractions of the robot's
  /// velocity and acceleration limits, and 0.02 rad within its position limits unless start or goal
  /// lie closer.
  void AddLimits(const LimitWeights& weights, double velocity_scale, double acceleration_scale);

  /// For a solver. The parameter blocks are the columns of states(); blocks of fixed states that
  /// are constants take part only where a free neighbour needs them.
  ceres::Problem& problem() { return problem_; }
  const Eigen::MatrixXd& states() const { return states_; }  ///< 2n x K, column k = (q_k, v_k)

  Trajectory GetTrajectory() const;

  /// The objective at the present states, by its parts; priors on fixed states count as `goal`.
  PlanCost ComputeCost() const;

 private:
  /// A cost function and the support states it reads: `state` and, if it has two blocks, the next.
  struct Term {
    const ceres::CostFunction* cost;
    int state;
    double PlanCost::*part;
  };
  void AddTerm(std::unique_ptr<ceres::CostFunction> cost, int state, double PlanCost::*part);
  void AddTerm(const ceres::CostFunction* cost, int state, double PlanCost::*part);

  const robot::RobotModel& robot_;
  Eigen::VectorXd t_s_;
  double step_s_;
  Eigen::VectorXd q_start_, q_goal_;
  int first_free_;  // the first state that is not a constant
  Eigen::MatrixXd states_;
  ObstacleHinge hinge_;
  std::vector<std::unique_ptr<ceres::CostFunction>> costs_;
  std::vector<Term> terms_;
  ceres::Problem problem_;
};

}  // namespace sidestep::planner
