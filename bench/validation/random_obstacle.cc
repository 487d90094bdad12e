#include "sidestep/bench/validation/random_obstacle.h"

#include <algorithm>
#include <cmath>

namespace sidestep::bench {
namespace {

using Eigen::Vector3d;

constexpr double kLongAfter_s = 1e9;

// Comes from all sides, through where the arm works.
scenarios::Motion RandomMotion(const ObstacleRange& range, RandomStream& random) {
  const double side_rad = random.Uniform(-2.6, 2.6);
  const double height_m = random.Uniform(0.2, 0.9);
  const Vector3d start_m(1.2 * std::cos(side_rad), 1.2 * std::sin(side_rad), height_m);
  const Vector3d through_m(random.Uniform(0.1, 0.6), random.Uniform(-0.6, 0.4), height_m);
  const Vector3d direction = (through_m - start_m).normalized();
  const double speed_m_s = random.Uniform(range.least_m_s, range.most_m_s);
  switch (random.Bits() % 3) {
    case 0:
      return scenarios::LinearMotion{start_m, direction, speed_m_s, kLongAfter_s, 0};
    case 1:
      return scenarios::AcceleratedMotion{start_m,
                                          direction,
                                          speed_m_s,
                                          random.Uniform(-range.most_m_s2, range.most_m_s2),
                                          random.Uniform(0, 5),
                                          range.most_m_s,
                                          kLongAfter_s,
                                          0};
    default: {
      const double least_m = speed_m_s * speed_m_s / range.most_m_s2;
      const double radius_m = std::max(least_m, random.Uniform(0.2, 0.8));
      return scenarios::CircleMotion{through_m + Vector3d(radius_m, 0, 0),
                                     radius_m,
                                     random.Uniform(-1.5, 1.5),
                                     random.Bits() % 2 == 0,
                                     speed_m_s,
                                     kLongAfter_s,
                                     0};
    }
  }
}

bool BeginsFarFromTheArm(const scenarios::MovingObstacle& box) {
  const Vector3d p_W = PoseAt(box, EpisodeTime(0)).translation();
  return (p_W - Vector3d(0, -0.3, 0.5)).norm() > 0.75;
}

}  // namespace

void SetRandomMotion(const ObstacleRange& range, RandomStream& random,
                     scenarios::Scenario& scenario) {
  scenarios::MovingObstacle& box = scenario.moving_obstacles.front();
  do {
    box.motion = RandomMotion(range, random);
  } while (!BeginsFarFromTheArm(box));
}

}  // namespace sidestep::bench
