#include "sidestep/hardware/recovery.h"

#include <algorithm>
#include <limits>

#include "sidestep/control/arm_capsules.h"
#include "sidestep/control/segment_box.h"
#include "sidestep/core/number_text.h"

namespace sidestep::hardware {
namespace {

using control::SafetyCheck;
using robot::fci::RobotMode;

constexpr double kNoticed_s = 0.12,
                 kStopped_s = 0.35;  // the longest stop of the supervisor's table
constexpr double kMargin_m = 0.03;
constexpr double kPause_s = 60;

double NearestObstacle_m(const RecoveryRequest& request, const robot::RobotModel& robot) {
  const control::ArmCapsules capsules(robot);
  control::JointVector q(robot.num_joints());
  std::copy(request.state.q.begin(), request.state.q.end(), q.begin());
  control::ArmCapsules::All placed;
  capsules.Place(q, placed);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < static_cast<std::size_t>(capsules.size()); ++c) {
    for (const ObstacleState& obstacle : request.obstacles) {
      const auto in_box = [&](const Eigen::Vector3d& p_W) {
        return obstacle.X_WO.RotateInverse(p_W - obstacle.X_WO.translation());
      };
      const double distance_m =
          control::SegmentBoxDistance(in_box(placed[c].a), in_box(placed[c].b),
                                      obstacle.half_extents_m) -
          placed[c].radius_m - obstacle.radius_m;
      nearest_m = std::min(nearest_m, distance_m);
    }
  }
  return nearest_m;
}

}  // namespace

double ProtectiveDistance(double speed_m_s) {
  return speed_m_s * (kNoticed_s + kStopped_s) + kMargin_m;
}

std::optional<Objection> WhyNotRecover(const RecoveryRequest& request,
                                       const robot::RobotModel& robot, double obstacle_speed_m_s) {
  if (request.state.mode == RobotMode::kUserStopped) {
    return Objection{SafetyCheck::kRecovery, "the user stop is pressed: release it first"};
  }
  if (request.state.mode == RobotMode::kGuiding) {
    return Objection{SafetyCheck::kRecovery, "somebody guides the arm by hand"};
  }
  const double nearest_m = NearestObstacle_m(request, robot);
  const double allowed_m = ProtectiveDistance(obstacle_speed_m_s);
  if (nearest_m < allowed_m) {
    return Objection{SafetyCheck::kRecovery,
                     "something is " + FiniteText("{:.2f} m", nearest_m) +
                         " from the arm, the protective distance is " +
                         FiniteText("{:.2f} m", allowed_m),
                     nearest_m, allowed_m};
  }
  if (request.since_last_s && *request.since_last_s < kPause_s) {
    return Objection{SafetyCheck::kRecovery,
                     "it was recovered " + FiniteText("{:.0f} s", *request.since_last_s) +
                         " ago, and may be once a minute: find out what stops it",
                     *request.since_last_s, kPause_s};
  }
  return std::nullopt;
}

}  // namespace sidestep::hardware
