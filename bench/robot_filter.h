#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "sidestep/control/arm_capsules.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/samples.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// Takes the robot out of the scans of cameras that see it. A point within a margin of a sphere or
/// capsule of the robot's model, as it was placed at the time of capture, is the robot's: the
/// camera has seen no more there than that its ray is free so far. The margin is what the scenario
/// says, for a camera and an arm that are not quite where they are said to be, and 4 standard
/// deviations of the camera's depth.
class RobotFilter {
 public:
  /// @param robot must outlive this.
  RobotFilter(const scenarios::Scenario& scenario, const robot::RobotModel& robot);

  /// Whether this sensor sees the robot, by its name.
  bool Sees(const std::string& sensor) const { return margins_.count(sensor) != 0; }

  /// @param q as it was measured when the scan was captured. @param scan of a sensor that sees it.
  void Remove(const Eigen::VectorXd& q, Scan* scan) const;

 private:
  struct Margin {
    double fixed_m = 0, noise_per_m = 0;
  };

  const robot::RobotModel& robot_;
  control::ArmCapsules capsules_;
  std::map<std::string, Margin> margins_;  // by sensor
};

/// What was measured of the joints nearest in time to `t`.
/// @param now the latest, if it is not among those recorded.
Eigen::VectorXd MeasuredAt(EpisodeTime t, const std::vector<ControlSample>& recorded,
                           const JointState& now);

}  // namespace sidestep::bench
