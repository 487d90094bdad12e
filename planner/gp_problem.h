#pragma once

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sidestep/core/trajectory.h"
#include "sidestep/planner/costs/obstacle_hinge.h"
#include "sidestep/planner/gp_objective.h"
#include "sidestep/planner/planner.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

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

  void AddLimits(const SoftLimits& limits);

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
  int first_free_;  // the first state that is not a constant
  Eigen::MatrixXd states_;
  ObstacleHinge hinge_;
  std::vector<std::unique_ptr<ceres::CostFunction>> costs_;
  std::vector<Term> terms_;
  ceres::Problem problem_;
};

}  // namespace sidestep::planner
