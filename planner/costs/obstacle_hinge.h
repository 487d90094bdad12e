#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/time.h"
#include "planner/costs/state_jacobian.h"
#include "robot/robot_model.h"
#include "sdf/distance_field.h"

namespace sidestep {

/// The mathematics of the obstacle costs. With phi the field, sphere s of radius r_s at p_WS(q):
///   h_s = max(0, epsilon + r_s - phi(p_WS(q), t)) / sigma,
/// and its gradient by the chain rule; at the seam, and where it is idle, the gradient is 0. Mount
/// spheres of the robot are left out: they overlap what it stands on and nothing pushes them out.
/// Outside the field's grid the answer is its clamp value: idle, if the field is clamped at no less
/// than epsilon + r_s.
/// Source: Mukadam et al., IJRR 37(11):1319-1340, 2018, section 5.2.
///
/// Holds the buffers of the latest evaluation: one thread at a time.
class ObstacleHinge {
 public:
  /// `robot` and `field` are borrowed.
  ObstacleHinge(const RobotModel& robot, const DistanceField& field, double epsilon_m,
                double sigma);

  int num_joints() const { return robot_.num_joints(); }
  /// S: those with a hinge, all but mount spheres.
  int num_spheres() const { return static_cast<int>(spheres_.size()); }

  /// Fills hinges() for q of shape n and, if asked, jacobian().
  void Evaluate(const Eigen::VectorXd& q, EpisodeTime t, bool with_jacobian);
  const Eigen::VectorXd& hinges() const { return hinges_; }     ///< shape S
  const RowMajorMatrix& jacobian() const { return jacobian_; }  ///< S x n, d h / d q

 private:
  const RobotModel& robot_;
  const DistanceField& field_;
  double sigma_;
  std::vector<int> spheres_;  // indices in the robot, of the S spheres
  Eigen::VectorXd reach_m_;   // epsilon + r_s
  Eigen::Matrix3Xd p_WS_;
  DistanceSamples samples_;
  Eigen::VectorXd hinges_;
  RowMajorMatrix jacobian_;
};

}  // namespace sidestep
