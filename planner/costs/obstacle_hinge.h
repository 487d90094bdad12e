#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/planner/costs/state_jacobian.h"
#include "sidestep/planner/self_clearance.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// The mathematics of the obstacle costs. With phi the field, sphere s of radius r_s at p_WS(q):
///   h_s = max(0, epsilon + r_s - phi(p_WS(q), t)) / sigma,
/// and its gradient by the chain rule; at the seam, and where it is idle, the gradient is 0. Mount
/// spheres of the robot are left out: they overlap what it stands on and nothing pushes them out.
/// Outside the field's grid the answer is its clamp value: idle, if the field is clamped at no less
/// than epsilon + r_s.
///
/// The robot's own links may be obstacles too: with g_l the gap between the links of pair l (see
/// self_clearance.h), a further h_l = max(0, self_epsilon - g_l) / sigma. Where two pairs of
/// spheres are equally near, its gradient is that of one of them. Source: Mukadam et al., IJRR
/// 37(11):1319-1340, 2018, section 5.2.
///
/// Holds the buffers of the latest evaluation: one thread at a time.
class ObstacleHinge {
 public:
  /// `robot` and `field` are borrowed. Without `self_epsilon_m` links do not see each other.
  ObstacleHinge(const robot::RobotModel& robot, const sdf::DistanceField& field, double epsilon_m,
                double sigma, std::optional<double> self_epsilon_m = std::nullopt,
                bool condensed = false);

  int num_joints() const { return robot_.num_joints(); }
  /// H: of each sphere but mount spheres, then of each pair of links.
  int num_hinges() const { return static_cast<int>(hinges_.size()); }

  /// The residuals of a cost function. Plain, they are the hinges. Condensed, they are n + 1
  /// numbers to the same effect (see condense_rows.h), of which only the length, R^T R and R^T r
  /// mean anything: evaluated without a Jacobian, their length stands in the last of them.
  int num_residuals() const { return condensed_ ? num_joints() + 1 : num_hinges(); }
  const Eigen::VectorXd& residuals() const { return condensed_ ? condensed_r_ : hinges_; }
  const RowMajorMatrix& residual_jacobian() const { return condensed_ ? condensed_J_ : jacobian_; }

  /// Fills hinges() for q of shape n and, if asked, jacobian().
  void Evaluate(const Eigen::VectorXd& q, EpisodeTime t, bool with_jacobian);
  const Eigen::VectorXd& hinges() const { return hinges_; }     ///< shape H
  const RowMajorMatrix& jacobian() const { return jacobian_; }  ///< H x n, d h / d q

 private:
  void Condense(bool with_jacobian);
  void EvaluateLinks(const robot::SphereCenters& centers, bool with_jacobian);

  const robot::RobotModel& robot_;
  const sdf::DistanceField& field_;
  double sigma_;
  std::vector<int> spheres_;  // indices in the robot, of those with a hinge
  Eigen::VectorXd reach_m_;   // epsilon + r_s
  SelfClearance links_;
  std::optional<double> self_epsilon_m_;
  Eigen::Matrix3Xd p_WS_;
  sdf::DistanceSamples samples_;
  Eigen::VectorXd hinges_;
  RowMajorMatrix jacobian_;
  bool condensed_;
  Eigen::VectorXd condensed_r_;
  RowMajorMatrix condensed_J_;
  Eigen::MatrixXd active_;  // rows (J, h) of the hinges that are not idle
};

}  // namespace sidestep::planner
