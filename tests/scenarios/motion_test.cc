#include <gtest/gtest.h>

#include <limits>

#include "scenarios/scenario.h"

namespace sidestep {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

MovingObstacle Moving(const Motion& motion) {
  return {"ball", Sphere{0.1}, Eigen::Vector3d::Zero(), motion, ""};
}

Eigen::Vector3d PositionAt(const Motion& motion, double t_s) {
  return PoseAt(Moving(motion), EpisodeTime(t_s)).translation();
}

void ExpectNear(const Eigen::Vector3d& value, const Eigen::Vector3d& expected) {
  EXPECT_LT((value - expected).norm(), 1e-12) << value.transpose();
}

TEST(LinearMotion, GoesStraightAtItsSpeed) {
  const LinearMotion motion{{0.4, 2, 0.6}, {0, -1, 0}, 1.4, kNever};
  ExpectNear(PositionAt(motion, 0), {0.4, 2, 0.6});
  ExpectNear(PositionAt(motion, 1.5), {0.4, -0.1, 0.6});
}

TEST(LinearMotion, RestsBeforeTheEpisodeAndAfterItsStop) {
  const LinearMotion motion{{0, 0, 0}, {1, 0, 0}, 0.5, 2};
  ExpectNear(PositionAt(motion, -1), {0, 0, 0});
  ExpectNear(PositionAt(motion, 2), {1, 0, 0});
  ExpectNear(PositionAt(motion, 9), {1, 0, 0});
}

TEST(WaypointMotion, GoesRoundTheCornerAtOneSpeed) {
  const WaypointMotion motion{{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}}, 0.5, kNever};
  ExpectNear(PositionAt(motion, 1), {0.5, 0, 0});
  ExpectNear(PositionAt(motion, 2), {1, 0, 0});
  ExpectNear(PositionAt(motion, 4), {1, 1, 0});
  ExpectNear(PositionAt(motion, 60), {1, 2, 0});
}

TEST(WaypointMotion, StopsOnItsWayWhenToldTo) {
  const WaypointMotion motion{{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}}, 0.5, 3};
  ExpectNear(PositionAt(motion, 60), {1, 0.5, 0});
}

TEST(MovingObstacle, KeepsItsOrientation) {
  MovingObstacle obstacle = Moving(LinearMotion{{0, 0, 0}, {1, 0, 0}, 1, kNever});
  obstacle.rpy_rad = {0, 0, 1.2};
  const Pose X_WO = PoseAt(obstacle, EpisodeTime(3));
  ExpectNear(X_WO.Rotate({1, 0, 0}), {std::cos(1.2), std::sin(1.2), 0});
}

}  // namespace
}  // namespace sidestep
