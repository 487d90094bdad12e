#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "sidestep/scenarios/scenario.h"

namespace sidestep::scenarios::motion_test {
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

TEST(AcceleratedMotion, GoesOnAtHalfTheSquareOfTheTime) {
  const AcceleratedMotion motion{{1, 0, 0}, {0, 1, 0}, 0.5, 2, 1, kNever, kNever, 0};
  ExpectNear(PositionAt(motion, 1), {1, 0.5, 0});
  ExpectNear(PositionAt(motion, 3), {1, 0.5 + 0.5 * 2 + 4, 0});
}

TEST(AcceleratedMotion, DoesNotExceedItsHighestSpeed) {
  const AcceleratedMotion motion{{0, 0, 0}, {1, 0, 0}, 0, 4, 0, 2, kNever, 0};
  ExpectNear(PositionAt(motion, 0.5), {0.5, 0, 0});
  ExpectNear(PositionAt(motion, 2.5), {0.5 + 4, 0, 0});
}

TEST(AcceleratedMotion, BrakesToRestAndDoesNotTurnBack) {
  const AcceleratedMotion motion{{0, 0, 0}, {1, 0, 0}, 2, -4, 0.5, kNever, kNever, 0};
  ExpectNear(PositionAt(motion, 1), {1.5, 0, 0});
  ExpectNear(PositionAt(motion, 9), {1.5, 0, 0});
}

TEST(CircleMotion, ComesRoundAfterItsLengthEitherWay) {
  CircleMotion motion{{1, 2, 0.5}, 0.5, 0, false, 1, kNever, 0};
  const double round_s = 2 * M_PI * 0.5;
  ExpectNear(PositionAt(motion, 0), {1.5, 2, 0.5});
  ExpectNear(PositionAt(motion, round_s / 4), {1, 2.5, 0.5});
  ExpectNear(PositionAt(motion, round_s), {1.5, 2, 0.5});
  motion.clockwise = true;
  ExpectNear(PositionAt(motion, round_s / 4), {1, 1.5, 0.5});
}

TEST(RandomWalkMotion, GoesAtItsSpeedWithoutJumps) {
  const RandomWalkMotion motion{{0, 0, 1}, 0.3, 0.5, 0.2, 7, 1.2, kNever, 0};
  for (double t_s = 0; t_s < 5; t_s += 0.01) {
    const double way_m = (PositionAt(motion, t_s + 0.01) - PositionAt(motion, t_s)).norm();
    EXPECT_LE(way_m, 0.012 + 1e-12);
    EXPECT_GE(way_m, 0.008);  // where it turns it cuts the corner
  }
  EXPECT_EQ(PositionAt(motion, 3).z(), 1);
}

TEST(RandomWalkMotion, IsAFunctionOfItsSeed) {
  const RandomWalkMotion motion{{0, 0, 1}, 0.3, 0.5, 0.2, 7, 1.2, kNever, 0};
  RandomWalkMotion other = motion;
  EXPECT_EQ(PositionAt(motion, 3), PositionAt(other, 3));
  other.seed = 8;
  EXPECT_GT((PositionAt(motion, 3) - PositionAt(other, 3)).norm(), 0.01);
}

TEST(RandomWalkMotion, TurnsAsMuchAsItIsToldTo) {
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const RandomWalkMotion motion{{0, 0, 0}, 0, 0.4, 1, seed, 1, kNever, 0};
    const Eigen::Vector3d second_leg = PositionAt(motion, 2) - PositionAt(motion, 1);
    sum += std::pow(std::atan2(second_leg.y(), second_leg.x()), 2);
  }
  EXPECT_NEAR(std::sqrt(sum / 500), 0.4, 0.04);
}

// Someone as in walkway_people, without the sway.
WalkMotion Walker(std::uint64_t seed) {
  return {{0, 0, 1}, {0, 1, 0}, {0.8, 1.8}, {0.5, 1.5}, {0.7, 1.3}, 0, 1, seed, 1.3, kNever, 0};
}

// Each pace of someone's walk and when it begins, seen from outside.
std::vector<std::pair<double, double>> PacesOf(const WalkMotion& motion, double until_s) {
  constexpr double kStep_s = 1e-3;
  std::vector<std::pair<double, double>> paces;
  for (int i = 1; i < until_s / kStep_s; ++i) {
    const double t_s = i * kStep_s;
    const auto pace = [&](double from_s) {
      return (PositionAt(motion, from_s + kStep_s) - PositionAt(motion, from_s)).y() / kStep_s;
    };
    const bool is_steady = std::abs(pace(t_s) - pace(t_s - kStep_s)) < 1e-9;
    const bool is_new = paces.empty() || std::abs(pace(t_s) - paces.back().second) > 1e-6;
    if (is_steady && is_new) paces.emplace_back(t_s, pace(t_s));
  }
  return paces;
}

TEST(WalkMotion, ChangesItsPaceByItsFactorsWithinItsBounds) {
  double first = 0, factors = 0, legs_s = 0;
  int num_factors = 0;
  constexpr int kSeeds = 60;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto paces = PacesOf(Walker(seed), 6);
    first += paces.front().second / kSeeds;
    for (std::size_t i = 0; i < paces.size(); ++i) {
      EXPECT_GE(paces[i].second, 0.8 - 1e-9);
      EXPECT_LE(paces[i].second, 1.8 + 1e-9);
      if (i == 0) continue;
      const double factor = paces[i].second / paces[i - 1].second;
      EXPECT_GE(factor, 0.7 - 1e-6);
      EXPECT_LE(factor, 1.3 + 1e-6);
      // Before and after a bound a change may not show.
      const auto at_a_bound = [](double pace) { return pace < 0.8 + 1e-6 || pace > 1.8 - 1e-6; };
      if (at_a_bound(paces[i].second) || at_a_bound(paces[i - 1].second)) continue;
      const double leg_s = paces[i].first - paces[i - 1].first;
      EXPECT_GE(leg_s, 0.5 - 0.003);
      EXPECT_LE(leg_s, 1.5 + 0.003);
      factors += factor;
      legs_s += leg_s;
      ++num_factors;
    }
  }
  EXPECT_GT(num_factors, 100);
  EXPECT_NEAR(first, 1.3, 4 * 1 / std::sqrt(12.0 * kSeeds));
  EXPECT_NEAR(factors / num_factors, 1, 4 * 0.6 / std::sqrt(12.0 * num_factors));
  EXPECT_NEAR(legs_s / num_factors, 1, 4 * 1 / std::sqrt(12.0 * num_factors));
}

TEST(WalkMotion, SwaysAboutItsLineAsOftenAsItIsToldTo) {
  WalkMotion motion = Walker(3);
  const WalkMotion straight = motion;
  motion.sway_m = 0.03;
  for (const double t_s : {0.0, 0.25, 0.5, 0.75, 1.0, 3.25}) {
    const Eigen::Vector3d sway = PositionAt(motion, t_s) - PositionAt(straight, t_s);
    ExpectNear(sway, {-0.03 * std::sin(2 * M_PI * t_s), 0, 0});
  }
}

TEST(WalkMotion, IsAFunctionOfItsSeed) {
  EXPECT_EQ(PositionAt(Walker(7), 3), PositionAt(Walker(7), 3));
  EXPECT_GT((PositionAt(Walker(7), 3) - PositionAt(Walker(8), 3)).norm(), 0.01);
}

TEST(WalkMotion, IsTheSameWalkAtAnotherSpeed) {
  WalkMotion motion = Walker(5);
  motion.sway_m = 0.03;
  WalkMotion slow = motion;
  slow.speed_m_s /= 2;
  for (const double t_s : {0.3, 1.0, 2.7}) {
    ExpectNear(PositionAt(slow, 2 * t_s), PositionAt(motion, t_s));
  }
}

TEST(EveryMotion, RestsAtItsStartUntilItBegins) {
  const Motion motions[] = {
      LinearMotion{{1, 2, 3}, {1, 0, 0}, 1, kNever, 0.5},
      WaypointMotion{{{1, 2, 3}, {2, 2, 3}}, 1, kNever, 0.5},
      AcceleratedMotion{{1, 2, 3}, {1, 0, 0}, 1, 1, 0, kNever, kNever, 0.5},
      CircleMotion{{0, 2, 3}, 1, 0, false, 1, kNever, 0.5},
      RandomWalkMotion{{1, 2, 3}, 0, 0.1, 0.5, 1, 1, kNever, 0.5},
      WalkMotion{
          {1, 2, 3}, {1, 0, 0}, {0.95, 1.05}, {0.5, 1}, {0.9, 1.1}, 0.02, 1, 1, 1, kNever, 0.5},
  };
  for (const Motion& motion : motions) {
    ExpectNear(PositionAt(motion, 0.5), {1, 2, 3});
    EXPECT_NEAR((PositionAt(motion, 0.6) - Eigen::Vector3d(1, 2, 3)).norm(), 0.1, 0.01);
  }
}

TEST(MovingObstacle, KeepsItsOrientation) {
  MovingObstacle obstacle = Moving(LinearMotion{{0, 0, 0}, {1, 0, 0}, 1, kNever});
  obstacle.rpy_rad = {0, 0, 1.2};
  const Pose X_WO = PoseAt(obstacle, EpisodeTime(3));
  ExpectNear(X_WO.Rotate({1, 0, 0}), {std::cos(1.2), std::sin(1.2), 0});
}

// A scenario of one moving ball, as a study makes it faster.
Scenario FasterScenario(const Motion& motion, double factor) {
  Scenario scenario;
  scenario.file = "fast.yaml";
  scenario.moving_obstacles = {Moving(motion)};
  scenario.lines["moving_obstacles[0].motion"] = 7;
  ScaleSpeeds(scenario, factor);
  return scenario;
}

TEST(ScaleSpeeds, LetsEveryMotionGoItsWaySoManyTimesAsFast) {
  const Motion motions[] = {
      LinearMotion{{0.4, 2, 0.6}, {0, -1, 0}, 1.4, kNever},
      WaypointMotion{{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}}, 0.5, kNever},
      AcceleratedMotion{{0, 0, 0}, {1, 0, 0}, 2, 3, 0.2, 2.5, kNever, 0},  // soon at its limit
      AcceleratedMotion{{0, 0, 0}, {1, 0, 0}, 2, 0, 0, 2, kNever, 0},      // at its limit
      AcceleratedMotion{{0, 0, 0}, {1, 0, 0}, 1.5, -2, 0.3, kNever, kNever, 0},
      CircleMotion{{1, 2, 0.5}, 0.5, 0.3, true, 0.7, kNever, 0},
      RandomWalkMotion{{1, 2, 0.5}, 0.3, 0.8, 0.4, 11, 0.7, kNever, 0},
      // Its changes of pace come sooner, too: it goes the same way, but not at each moment as fast.
      WalkMotion{{1, 2, 0.5}, {1, 0, 0}, {0.7, 0.7}, {0.3, 0.6}, {1, 1}, 0, 1, 11, 0.7, kNever, 0},
  };
  for (const Motion& motion : motions) {
    for (const double factor : {0.0, 0.75, 1.0, 1.3, 2.0}) {
      const Scenario faster = FasterScenario(motion, factor);
      const auto way = [](const Motion& any, double t_s) {  // by small steps, against closed forms
        double way_m = 0;
        for (int i = 0; i < 2000; ++i) {
          way_m += (PositionAt(any, t_s * (i + 1) / 2000) - PositionAt(any, t_s * i / 2000)).norm();
        }
        return way_m;
      };
      EXPECT_NEAR(way(faster.moving_obstacles[0].motion, 1.1), factor * way(motion, 1.1), 2e-3)
          << "motion " << motion.index() << ", factor " << factor;
    }
  }
}

TEST(ScaleSpeeds, NeverLiftsASpeedAboveItsLimit) {
  const AcceleratedMotion motion{{0, 0, 0}, {1, 0, 0}, 2, 1, 0, 2.1, kNever, 0};
  for (double factor = 0.7; factor < 1.4; factor += 0.013) {
    const Scenario faster = FasterScenario(motion, factor);
    const auto& scaled = std::get<AcceleratedMotion>(faster.moving_obstacles[0].motion);
    EXPECT_EQ(scaled.speed_m_s, 2 * factor);
    EXPECT_LE(scaled.speed_m_s, scaled.max_speed_m_s) << factor;
  }
}

TEST(ScaleSpeeds, RefusesWhatNoScenarioFileMaySay) {
  const LinearMotion motion{{0, 0, 0}, {1, 0, 0}, 9e11, kNever};
  EXPECT_NO_THROW(FasterScenario(motion, 1.1));
  try {
    FasterScenario(motion, 1.2);
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "fast.yaml:7: moving_obstacles[0].motion: is too fast: 1.2 times as fast is "
                 "beyond 1e12");
  }
  EXPECT_THROW(FasterScenario(motion, -1), std::invalid_argument);
  EXPECT_THROW(FasterScenario(motion, kNever), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::scenarios::motion_test
