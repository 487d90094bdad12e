#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/gp_objective.h"
#include "sidestep/planner/objective/chain_kernels.h"
#include "sidestep/planner/objective/chain_quadratic.h"
#include "sidestep/planner/objective/interval_quadratic.h"
#include "sidestep/planner/objective/obstacle_objective.h"
#include "sidestep/planner/objective/smoothness_bound.h"
#include "sidestep/planner/planner.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// The objective of GpProblem, term for term, as a quadratic around a trajectory: for solvers that
/// want cost, gradient and Gauss-Newton Hessian at once. The blocks of the quadratic are the free
/// states, from first_free() on.
///
/// The field's slices are made once, the memory is kept from one evaluation to the next. One thread
/// at a time.
class TrajectoryObjective {
 public:
  /// @param t_s of the support states since the request's start: the grid of all guesses.
  /// `robot` and the request's field are borrowed.
  TrajectoryObjective(const robot::RobotModel& robot, const PlanRequest& request,
                      const Eigen::VectorXd& t_s, const GpProblemOptions& options)
      : TrajectoryObjective(MakeArm(robot, options), request, t_s, options) {}
  /// The same with the robot as these options see it, for who makes many.
  TrajectoryObjective(std::shared_ptr<const obstacle_kernels::Arm> arm, const PlanRequest& request,
                      const Eigen::VectorXd& t_s, const GpProblemOptions& options);
  static std::shared_ptr<const obstacle_kernels::Arm> MakeArm(const robot::RobotModel& robot,
                                                              const GpProblemOptions& options);

  /// Takes what is fixed from `initial`, and leaves limits out.
  void Restart(const Trajectory& initial);
  void AddLimits(const SoftLimits& limits) { limits_ = limits; }

  int first_free() const { return first_free_; }
  int num_states() const { return static_cast<int>(t_s_.size()); }
  int num_joints() const { return n_; }
  const Eigen::VectorXd& t_s() const { return t_s_; }
  ChainQuadratic MakeQuadratic() const { return {n_, num_states() - first_free_}; }

  /// @param states 2n x K, column k = (q_k, v_k).
  void Evaluate(const Eigen::MatrixXd& states, ChainQuadratic& quadratic);

  /// At most so much can a step lower the quadratic of the last evaluation.
  double MostDecrease(const ChainQuadratic& quadratic) const {
    return bound_->MostDecrease(quadratic);
  }

  /// In parts, for solvers that assemble for themselves: Look, then the step of each free state k,
  /// which is all that is said of state k and of the interval before it, but for its priors.
  void Look(const Eigen::MatrixXd& states);
  /// Adds step k of the states last looked at; `block` is that of state k, the one before it (if
  /// there is one) that of state k - 1.
  void AddStep(const Eigen::MatrixXd& states, int k, int block, ChainQuadratic& quadratic);

  struct Prior {
    int state = 0;
    Eigen::VectorXd x;  ///< 2n
    double sigma = 0;
  };
  const std::vector<Prior>& priors() const { return priors_; }

 private:
  // A configuration at which obstacles count: state `state`, or between it and the next.
  struct Place {
    int state = 0;
    bool is_between = false;
    std::array<double, 4> weights{};  // of (q, v, q, v) of the interval that it lies in or ends
  };
  void AddObstacles(int k, int block, ChainQuadratic& quadratic);
  void AddInterval(const Eigen::MatrixXd& states, int k, int block,
                   ChainQuadratic& quadratic) const;
  void AddJoint(const std::array<double, 4>& gradient, const Eigen::Matrix4d& hessian, int i,
                int block, ChainQuadratic& quadratic) const;
  void AddStateLimits(const Eigen::MatrixXd& states, int k, int block,
                      ChainQuadratic& quadratic) const;

  GpProblemOptions options_;
  int n_;
  Eigen::VectorXd t_s_;
  double step_s_;
  int num_fixed_, first_free_;
  Eigen::VectorXd x_start_, x_goal_;  // 2n
  std::vector<Prior> priors_;
  std::optional<SoftLimits> limits_;
  GpInterval gp_;
  std::optional<SmoothnessBound> bound_;

  ObstacleObjective obstacles_;
  std::vector<Place> places_;           // in the order of time
  std::vector<std::size_t> end_place_;  // of each free state: its places end here
  std::vector<std::unique_ptr<const sdf::FieldSlice>> slices_;
  std::vector<const sdf::FieldSlice*> slice_of_;
  Eigen::MatrixXd q_;  // n x places
  ObstacleQuadratics at_places_;
  std::vector<chain_kernels::BetweenStates> between_;  // of the step that is added
};

}  // namespace sidestep::planner
