#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/costs/obstacle_hinge.h"
#include "sidestep/planner/gauss_newton_band.h"
#include "sidestep/planner/planner.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// Units as in the cost functions of planner/costs/.
struct GaussNewtonOptions {
  double epsilon_m = 0.2;
  double sigma_obs = 0.05;
  int num_interpolated = 1;  ///< obstacle costs inside each interval, evenly spaced
  double qc = 1;
  /// A solve stops after this many steps, or when one lowers the objective by no more than either
  /// of the two. The defaults are GTSAM's.
  int max_iterations = 100;
  double absolute_decrease = 1e-5;
  double relative_decrease = 1e-5;
  PlanBudget budget = {};  ///< ends it likewise
};

/// What one solve did. `errors` holds the objective before it and after each of its steps.
struct GaussNewtonSummary {
  std::vector<double> errors;
  bool converged = false;  ///< false: it ran into max_iterations
  int iterations() const { return static_cast<int>(errors.size()) - 1; }
};

/// The objective of GpProblem without limit costs, minimised by plain Gauss-Newton: full steps, no
/// damping, no line search. That is how GTSAM runs in the published experiments of Finean, Merkt &
/// Havoutis (ICAPS 2021), with a stopping rule to be known: a step that *raises* the objective ends
/// the solve too, and is kept.
///
/// States are coupled with their neighbours alone, so a step is a block tridiagonal solve. What
/// each interval contributes is kept until its states or its field change. One thread at a time.
class GaussNewton {
 public:
  /// @param robot is borrowed. @param initial the first states, on an even grid of >= 2 times.
  /// @throws std::invalid_argument for options out of range or a trajectory that does not fit.
  GaussNewton(const robot::RobotModel& robot, const Trajectory& initial,
              const GaussNewtonOptions& options);

  /// What the obstacle costs of state `k` and of the interval that ends there see from now on;
  /// until it is called they are absent. The field is sampled at `start` + the time of each
  /// configuration since the trajectory's begin. It is borrowed.
  void SetField(int k, const sdf::DistanceField& field, EpisodeTime start);

  /// Draws state k to (q, v). Further priors on the same state add to it.
  void AddPrior(int k, const Eigen::VectorXd& q, const Eigen::VectorXd& v, double sigma);

  GaussNewtonSummary Solve();

  Trajectory GetTrajectory() const;

  /// The objective at the present states, by its parts; all priors count as `goal`.
  PlanCost ComputeCost();

 private:
  /// What the obstacle costs of one step add to the normal equations, as a quadratic in two
  /// neighbours (q, v, q, v): state k and the one before, for state 0 the one after. Of H only the
  /// blocks on and below the diagonal are filled.
  struct StepObstacles {
    std::unique_ptr<ObstacleHinge> hinge;  ///< none: no obstacle costs
    EpisodeTime start;
    bool is_current = false;
    double error = 0;
    Eigen::MatrixXd H;         // 4n x 4n
    Eigen::VectorXd gradient;  // shape 4n
  };
  struct Prior {
    int k;
    Eigen::VectorXd x;
    double sigma;
  };

  void Linearise(int k);
  // Adds the hinges at the configuration that is the sum of `weights` times (q, v, q, v) of states
  // `begin` and begin + 1, at that share of the time between them.
  void AddHinges(StepObstacles& step, int begin, const Eigen::Vector4d& weights, double share);
  bool Step();

  const robot::RobotModel& robot_;
  GaussNewtonOptions options_;
  int n_, K_;
  Eigen::VectorXd t_s_;
  double step_s_;
  Eigen::MatrixXd states_;                // 2n x K, column k = (q_k, v_k)
  std::vector<Eigen::Vector4d> weights_;  // of (q, v, q, v), for each configuration in an interval
  Eigen::Matrix4d gp_joint_;              // Hessian of one interval and joint, in (q, v, q, v)
  Eigen::MatrixXd gp_pair_;               // of all joints, 4n x 4n
  std::vector<StepObstacles> obstacles_;
  std::vector<Prior> priors_;
  BlockTridiagonal hessian_;
};

}  // namespace sidestep::planner
