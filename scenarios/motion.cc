#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "sidestep/core/random.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::scenarios {
namespace {

// How long a motion has been under way at t.
template <class Motion>
double Elapsed(const Motion& motion, double t_s) {
  const double stop_s = std::max(motion.begin_at_s, motion.stop_at_s);
  return std::clamp(t_s, motion.begin_at_s, stop_s) - motion.begin_at_s;
}

Eigen::Vector3d PositionAfter(const LinearMotion& motion, double elapsed_s) {
  return motion.start_m + elapsed_s * motion.speed_m_s * motion.direction;
}

Eigen::Vector3d PositionAfter(const WaypointMotion& motion, double elapsed_s) {
  double left_m = elapsed_s * motion.speed_m_s;
  for (std::size_t i = 1; i < motion.points_m.size(); ++i) {
    const Eigen::Vector3d leg = motion.points_m[i] - motion.points_m[i - 1];
    const double length_m = leg.norm();
    if (left_m < length_m) return motion.points_m[i - 1] + left_m / length_m * leg;
    left_m -= length_m;
  }
  return motion.points_m.back();
}

Eigen::Vector3d PositionAfter(const AcceleratedMotion& motion, double elapsed_s) {
  const double v = motion.speed_m_s, a = motion.acceleration_m_s2;
  const double steady_s = std::min(elapsed_s, motion.change_at_s);
  const double changing_s = elapsed_s - steady_s;
  // Until rest or the highest speed; after that the speed stays.
  const double last_speed = a < 0 ? 0 : motion.max_speed_m_s;
  const double ends_s = a == 0 ? changing_s : std::clamp((last_speed - v) / a, 0.0, changing_s);
  const double way_m =
      v * steady_s + (v + a * ends_s / 2) * ends_s + (v + a * ends_s) * (changing_s - ends_s);
  return motion.start_m + way_m * motion.direction;
}

Eigen::Vector3d PositionAfter(const CircleMotion& motion, double elapsed_s) {
  const double turned_rad = elapsed_s * motion.speed_m_s / motion.radius_m;
  const double angle_rad = motion.start_angle_rad + (motion.clockwise ? -turned_rad : turned_rad);
  return motion.center_m +
         motion.radius_m * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0);
}

struct Walker {
  Eigen::Vector3d p_WO;
  double heading_rad;
};

Walker WalkFor(const RandomWalkMotion& motion, double elapsed_s) {
  RandomStream random(motion.seed, "random walk");
  Eigen::Vector3d position_m = motion.start_m;
  double heading_rad = motion.heading_rad;
  while (true) {
    const double leg_s = std::min(elapsed_s, motion.turn_every_s);
    position_m +=
        leg_s * motion.speed_m_s * Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0);
    elapsed_s -= leg_s;
    if (!(elapsed_s > 0)) return {position_m, heading_rad};
    heading_rad += motion.turn_rad * random.Normal();
  }
}

Eigen::Vector3d PositionAfter(const RandomWalkMotion& motion, double elapsed_s) {
  return WalkFor(motion, elapsed_s).p_WO;
}

// The time on the walk's own clock.
double WalkTime(const WalkMotion& motion, double elapsed_s) {
  return motion.speed_m_s / motion.pace_m_s.middle() * elapsed_s;
}

double WayWalked(const WalkMotion& motion, double walked_s) {
  RandomStream random(motion.seed, "walk");
  const auto draw = [&](const Range& range) { return random.Uniform(range.least, range.most); };
  double way_m = 0, pace_m_s = draw(motion.pace_m_s);
  while (true) {
    const double leg_s = std::min(walked_s, draw(motion.pace_every_s));
    way_m += leg_s * pace_m_s;
    walked_s -= leg_s;
    if (!(walked_s > 0)) return way_m;
    pace_m_s = std::clamp(pace_m_s * draw(motion.pace_factor), motion.pace_m_s.least,
                          motion.pace_m_s.most);
  }
}

Eigen::Vector3d PositionAfter(const WalkMotion& motion, double elapsed_s) {
  const double walked_s = WalkTime(motion, elapsed_s);
  const double swayed_m =
      motion.sway_m * std::sin(2 * std::numbers::pi * motion.sway_rate_hz * walked_s);
  return motion.start_m + WayWalked(motion, walked_s) * motion.direction +
         swayed_m * LeftOf(motion.direction);
}

// The time on the track's own clock.
double TrackTime(const RecordedMotion& motion, double elapsed_s) {
  const double recorded_m_s = motion.track->mean_speed_m_s();
  return recorded_m_s > 0 ? motion.speed_m_s / recorded_m_s * elapsed_s : elapsed_s;
}

Eigen::Vector3d PositionAfter(const RecordedMotion& motion, double elapsed_s) {
  return motion.track->Position(TrackTime(motion, elapsed_s));
}

Eigen::Vector3d AlongHeading(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad), 0};
}

bool IsLevel(const Eigen::Vector3d& direction) {
  return direction.head<2>().norm() > 1e-6 * direction.norm();
}

Eigen::Vector3d DirectionAfter(const LinearMotion& motion, double) { return motion.direction; }

Eigen::Vector3d DirectionAfter(const WaypointMotion& motion, double elapsed_s) {
  double left_m = elapsed_s * motion.speed_m_s;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i < motion.points_m.size(); ++i) {
    const Eigen::Vector3d leg = motion.points_m[i] - motion.points_m[i - 1];
    if (IsLevel(leg)) direction = leg;
    left_m -= leg.norm();
    if (left_m < 0 && IsLevel(direction)) break;
  }
  return direction;
}

Eigen::Vector3d DirectionAfter(const AcceleratedMotion& motion, double) {
  return motion.direction;  // it does not turn back
}

Eigen::Vector3d DirectionAfter(const CircleMotion& motion, double elapsed_s) {
  const double turned_rad = elapsed_s * motion.speed_m_s / motion.radius_m;
  const double angle_rad = motion.start_angle_rad + (motion.clockwise ? -turned_rad : turned_rad);
  const Eigen::Vector3d left(-std::sin(angle_rad), std::cos(angle_rad), 0);
  return motion.clockwise ? Eigen::Vector3d(-left) : left;
}

Eigen::Vector3d DirectionAfter(const RandomWalkMotion& motion, double elapsed_s) {
  return AlongHeading(WalkFor(motion, elapsed_s).heading_rad);
}

Eigen::Vector3d DirectionAfter(const WalkMotion& motion, double) {
  return motion.direction;  // who sways does not turn
}

Eigen::Vector3d DirectionAfter(const RecordedMotion& motion, double elapsed_s) {
  return AlongHeading(motion.track->Heading(TrackTime(motion, elapsed_s)));
}

// What the motion itself adds to the obstacle's own orientation, if it turns at all.
std::optional<Eigen::Quaterniond> TurnAt(const MovingObstacle& obstacle, EpisodeTime t) {
  if (obstacle.faces_path) {
    const Eigen::Vector3d direction = DirectionAt(obstacle.motion, t);
    const double yaw_rad = std::atan2(direction.y(), direction.x());  // 0 of zero
    return Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  }
  const auto* const recorded = std::get_if<RecordedMotion>(&obstacle.motion);
  if (recorded == nullptr || !recorded->track->has_rotations()) return std::nullopt;
  return recorded->track->Rotation(TrackTime(*recorded, Elapsed(*recorded, t.seconds())));
}

}  // namespace

Pose PoseAt(const MovingObstacle& obstacle, EpisodeTime t) {
  const Eigen::Vector3d p_WO = std::visit(
      [&](const auto& motion) { return PositionAfter(motion, Elapsed(motion, t.seconds())); },
      obstacle.motion);
  const Pose X_WO = Pose::FromRollPitchYaw(obstacle.rpy_rad, p_WO);
  const std::optional<Eigen::Quaterniond> turn = TurnAt(obstacle, t);
  return turn ? Pose(*turn * X_WO.rotation(), p_WO) : X_WO;
}

Eigen::Vector3d LeftOf(const Eigen::Vector3d& direction) {
  return {-direction.y(), direction.x(), 0};
}

Eigen::Vector3d DirectionAt(const Motion& motion, EpisodeTime t) {
  const Eigen::Vector3d direction = std::visit(
      [&](const auto& any) { return DirectionAfter(any, Elapsed(any, t.seconds())); }, motion);
  return IsLevel(direction) ? direction : Eigen::Vector3d(0, 0, 0);
}

}  // namespace sidestep::scenarios
