#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// The narrowest place between two links.
struct LinkGap {
  int first = 0, second = 0;  ///< spheres, indices in the robot
  double gap_m = 0;           ///< between their surfaces, negative where they overlap
};

/// How far the links of the robot's self_collision() are from each other, by their spheres.
/// Immutable; safe from many threads.
class SelfClearance {
 public:
  /// `robot` is borrowed.
  explicit SelfClearance(const robot::RobotModel& robot);

  int num_pairs() const { return static_cast<int>(pairs_.size()); }
  /// Of pair `pair`, in the order of self_collision(). @param p_WS all sphere centres, 3 x S.
  LinkGap Find(int pair, const Eigen::Matrix3Xd& p_WS) const;
  /// The least gap of all pairs [m]; infinite without a pair.
  double Least(const Eigen::Matrix3Xd& p_WS) const;

 private:
  const robot::RobotModel& robot_;
  std::vector<std::vector<std::pair<int, int>>> pairs_;  // of links: the pairs of their spheres
};

}  // namespace sidestep::planner
