#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "sidestep/planner/objective/arm_group.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/aligned_vector.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// What the obstacle costs say of one configuration, as a quadratic in its step dq:
/// cost + gradient^T dq + dq^T hessian dq / 2, with the Gauss-Newton Hessian.
struct ObstacleQuadratic {
  double cost = 0;
  Eigen::VectorXd gradient;  ///< n
  Eigen::MatrixXd hessian;   ///< n x n
};

/// The same of many configurations, padded with zeros for those who work on them by vectors.
class ObstacleQuadratics {
 public:
  /// Rows of gradient and Hessian: n, rounded up.
  static int PaddedRows(int num_joints) { return (num_joints + 7) / 8 * 8; }

  ObstacleQuadratics(int num_joints, int count);

  int count() const { return static_cast<int>(costs_.size()); }
  double& cost(int c) { return costs_[static_cast<std::size_t>(c)]; }
  double cost(int c) const { return costs_[static_cast<std::size_t>(c)]; }
  /// n numbers and zeros.
  double* gradient(int c) {
    return &gradients_[static_cast<std::size_t>(c) * static_cast<std::size_t>(rows_)];
  }
  const double* gradient(int c) const {
    return &gradients_[static_cast<std::size_t>(c) * static_cast<std::size_t>(rows_)];
  }
  /// n columns, each of n numbers and zeros.
  double* hessian(int c) {
    return &hessians_[static_cast<std::size_t>(c) * static_cast<std::size_t>(n_ * rows_)];
  }
  const double* hessian(int c) const {
    return &hessians_[static_cast<std::size_t>(c) * static_cast<std::size_t>(n_ * rows_)];
  }
  ObstacleQuadratic Get(int c) const;

 private:
  int n_, rows_;
  std::vector<double> costs_;
  sdf::AlignedVector<double> gradients_, hessians_;
};

/// The obstacle costs of obstacle_hinge.h for many configurations at once, several at a time by
/// SIMD. The answer to each depends neither on the others nor, to the last bit, on the instruction
/// set.
class ObstacleObjective {
 public:
  explicit ObstacleObjective(std::shared_ptr<const obstacle_kernels::Arm> arm);

  /// @param q n x C, column c a configuration; @param slices C, what each of them sees.
  /// @param quadratics of C; where a cost is 0, the rest stays as it was.
  void Evaluate(const Eigen::MatrixXd& q, const std::vector<const sdf::FieldSlice*>& slices,
                ObstacleQuadratics& quadratics);

 private:
  ArmGroup group_;
  sdf::AlignedVector<double> terms_8_;  // as in obstacle_kernels.h
};

/// What the costs themselves (ObstacleHinge) say of one configuration: the readable reference.
ObstacleQuadratic ReferenceQuadratic(const robot::RobotModel& robot,
                                     const sdf::DistanceField& field, double epsilon_m,
                                     double sigma, std::optional<double> self_epsilon_m,
                                     const Eigen::VectorXd& q, EpisodeTime t);

}  // namespace sidestep::planner
