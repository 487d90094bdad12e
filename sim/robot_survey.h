#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <string>
#include <vector>

#include "sidestep/robot/robot_model.h"

namespace sidestep::sim {

// What can be told of a robot by looking at many configurations. `model` is always its MJCF alone,
// which agrees with robot.yaml (sim/robot_agreement.h).

/// How far robot.yaml and the MJCF put the frame of a link apart, at the worst of all links and
/// configurations.
struct FrameDifference {
  double apart_m = 0, turned_rad = 0;
  std::string link;
};
/// Of the links that a body, or a site, of the MJCF stands for: of their name, or after row i of a
/// Denavit-Hartenberg table the site `dh<i>`.
FrameDifference FindWorstFrame(const robot::RobotModel& robot, const mjModel& model,
                               int num_configurations, std::uint64_t seed);

/// Two bodies of the MJCF that touch.
struct SelfContact {
  int first = 0, second = 0;  ///< the links that carry them (-1: the base), first <= second
  std::string first_body, second_body;
};
/// By MuJoCo, which leaves out parents and their children, and what the MJCF excludes.
std::vector<SelfContact> FindSelfContacts(const robot::RobotModel& robot, const mjModel& model,
                                          const Eigen::VectorXd& q);

/// At how many random configurations two links touched, and at how many their spheres overlapped
/// though they did not touch.
struct PairCount {
  int first = 0, second = 0;  ///< first < second
  int touched = 0;
  int false_alarms = 0;
};
struct SelfContactSurvey {
  int num_configurations = 0;
  int num_touching = 0;          ///< with any contact
  std::vector<PairCount> pairs;  ///< all two links that have solids, in order
};
SelfContactSurvey SurveySelfContacts(const robot::RobotModel& robot, const mjModel& model,
                                     int num_configurations, std::uint64_t seed);

}  // namespace sidestep::sim
