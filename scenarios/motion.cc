#include <algorithm>
#include <cstddef>

#include "scenarios/scenario.h"

namespace sidestep {
namespace {

Eigen::Vector3d PositionAt(const LinearMotion& motion, double t_s) {
  return motion.start_m +
         std::clamp(t_s, 0.0, motion.stop_at_s) * motion.speed_m_s * motion.direction;
}

Eigen::Vector3d PositionAt(const WaypointMotion& motion, double t_s) {
  double left_m = std::clamp(t_s, 0.0, motion.stop_at_s) * motion.speed_m_s;
  for (std::size_t i = 1; i < motion.points_m.size(); ++i) {
    const Eigen::Vector3d leg = motion.points_m[i] - motion.points_m[i - 1];
    const double length_m = leg.norm();
    if (left_m < length_m) return motion.points_m[i - 1] + left_m / length_m * leg;
    left_m -= length_m;
  }
  return motion.points_m.back();
}

}  // namespace

Pose PoseAt(const MovingObstacle& obstacle, EpisodeTime t) {
  const Eigen::Vector3d p_WO = std::visit(
      [&](const auto& motion) { return PositionAt(motion, t.seconds()); }, obstacle.motion);
  return Pose::FromRollPitchYaw(obstacle.rpy_rad, p_WO);
}

}  // namespace sidestep
