#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "sidestep/planner/objective/obstacle_kernels.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/aligned_vector.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/point_block.h"

namespace sidestep::planner {

/// A robot as obstacle costs and verdicts see it: worked out once, shared by those who look.
/// Arguments as of ObstacleHinge, but for the field.
std::shared_ptr<const obstacle_kernels::Arm> MakeArm(const robot::RobotModel& robot,
                                                     double epsilon_m, double sigma,
                                                     std::optional<double> self_epsilon_m);

/// Up to kSize configurations of an arm that are worked on together: where their spheres are, and
/// what fields say there of those that obstacle costs and verdicts look at.
class ArmGroup {
 public:
  static constexpr int kSize = static_cast<int>(obstacle_kernels::kGroup);

  explicit ArmGroup(std::shared_ptr<const obstacle_kernels::Arm> arm);

  /// @param q n x 1 to n x kSize, column c a configuration.
  void Place(const Eigen::Ref<const Eigen::MatrixXd>& q) { Place(q, axes_8_.data()); }
  /// The same for who has no use for axes_8(), which are left as they were.
  void PlaceSpheres(const Eigen::Ref<const Eigen::MatrixXd>& q) { Place(q, nullptr); }
  /// Asks what configuration c sees. @return how many of its spheres are outside what was mapped.
  int Sample(int c, const sdf::FieldSlice& slice) { return Ask(c, slice, /*with_gradients=*/true); }
  /// The same of distances alone; gradients of samples_8() are left as they were.
  int Measure(int c, const sdf::FieldSlice& slice) {
    return Ask(c, slice, /*with_gradients=*/false);
  }

  const obstacle_kernels::Arm& arm() const { return *arm_; }
  /// As in obstacle_kernels.h.
  const double* axes_8() const { return axes_8_.data(); }
  const double* centers_8() const { return centers_8_.data(); }
  const double* samples_8() const { return samples_8_.data(); }

 private:
  void Place(const Eigen::Ref<const Eigen::MatrixXd>& q, double* axes_8);
  int Ask(int c, const sdf::FieldSlice& slice, bool with_gradients);

  std::shared_ptr<const obstacle_kernels::Arm> arm_;
  sdf::AlignedVector<double> q_8_, axes_8_, centers_8_, samples_8_;
  sdf::AlignedVector<sdf::PointBlock> blocks_;  // of the hinges' spheres: kSize for each 64 of them
};

}  // namespace sidestep::planner
