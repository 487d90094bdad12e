#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/shape_field.h"

namespace sidestep::imports {

/// Where a robot can be among what stands still in a scenario: by its collision spheres and the
/// exact distances to the shapes.
class FreeSpace {
 public:
  /// @param robot is borrowed.
  FreeSpace(const scenarios::Scenario& scenario, const robot::RobotModel& robot);

  /// How far the robot is from everything, and its links from each other [m]; negative where
  /// something overlaps. Mount spheres and what they stand on are no matter. Links that are kept
  /// apart are those of self_collision; of a robot that names none, those whose spheres do not
  /// overlap at any of its named configurations.
  double Clearance(const Eigen::VectorXd& q) const;

 private:
  const robot::RobotModel& robot_;
  sdf::ShapeField all_, but_for_the_mount_;
  std::vector<char> is_of_mount_;                ///< of each sphere
  std::vector<std::pair<int, int>> kept_apart_;  ///< pairs of spheres
};

}  // namespace sidestep::imports
