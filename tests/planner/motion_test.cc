// First guesses, and what motions are judged by: clearance and use of limits.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sidestep/planner/clearance.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/limit_use.h"
#include "sidestep/robot/tolerance_scale.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::motion_test {
namespace {

PlanRequest Request() {
  PlanRequest request;
  request.step_s = 0.1;
  request.num_states = 31;
  request.q_start = Eigen::Vector2d(-1, 0.5);
  request.v_start = Eigen::Vector2d::Zero();
  request.q_goal = Eigen::Vector2d(1, -0.5);
  return request;
}

class DirectMotion : public ::testing::TestWithParam<Timing> {};

TEST_P(DirectMotion, GoesInAStraightLineFromRestToRest) {
  const PlanRequest request = Request();
  const Trajectory motion = MakeDirectMotion(request, GetParam());
  EXPECT_EQ(motion.q.col(0), request.q_start);
  EXPECT_EQ(motion.q.col(30), request.q_goal);
  EXPECT_EQ(motion.v.col(30), Eigen::Vector2d::Zero());
  const Eigen::Vector2d way = request.q_goal - request.q_start;
  double progress = 0;
  for (int k = 0; k < 31; ++k) {
    const Eigen::Vector2d moved = motion.q.col(k) - request.q_start;
    EXPECT_NEAR(moved(0) * way(1), moved(1) * way(0), 1e-12);
    EXPECT_GE(moved.dot(way), progress - 1e-12) << "never back";
    progress = moved.dot(way);
  }
}

TEST_P(DirectMotion, GoesOnSmoothlyFromMovingFixedStates) {
  PlanRequest request = Request();
  request.initial = MakeDirectMotion(request, Timing::kWholeTime);
  request.num_fixed = 11;
  const Trajectory motion = MakeDirectMotion(request, GetParam());
  EXPECT_EQ(motion.q.leftCols(11), request.initial->q.leftCols(11));
  EXPECT_EQ(motion.v.leftCols(11), request.initial->v.leftCols(11));
  EXPECT_EQ(motion.q.col(30), request.q_goal);
  // No kick: accelerations stay near those of 0.4 to 0.6 of the free 2 s.
  EXPECT_LT(MeasureLimitUse(MakePlanarArm(), motion, 0).acceleration, 0.6);
}

INSTANTIATE_TEST_SUITE_P(Timings, DirectMotion,
                         ::testing::Values(Timing::kWholeTime, Timing::kLeaveLate,
                                           Timing::kArriveEarly));

TEST(DirectMotion, HasGoneHalfWayAtDifferentTimes) {
  const auto half_way = [](Timing timing) {
    return MakeDirectMotion(Request(), timing).q.row(0).cwiseAbs().minCoeff();
  };
  EXPECT_NEAR(MakeDirectMotion(Request(), Timing::kWholeTime).q(0, 15), 0, 1e-12);
  EXPECT_NEAR(MakeDirectMotion(Request(), Timing::kLeaveLate).q(0, 21), 0, 1e-12);
  EXPECT_NEAR(MakeDirectMotion(Request(), Timing::kArriveEarly).q(0, 9), 0, 1e-12);
  EXPECT_NEAR(half_way(Timing::kLeaveLate), 0, 1e-12);
}

TEST(Detour, LeadsFromTheFixedStatesToTheGoalOffTheDirectLine) {
  PlanRequest request = Request();
  request.initial = MakeDirectMotion(request, Timing::kWholeTime);
  request.num_fixed = 6;
  RandomStream random(1, "test");
  const Eigen::Vector2d way = request.q_goal - request.q_start;
  double furthest_rad = 0;
  for (int i = 0; i < 20; ++i) {
    const Trajectory motion = MakeDetour(request, Eigen::Vector2d::Ones(), random);
    EXPECT_EQ(motion.q.leftCols(6), request.initial->q.leftCols(6));
    EXPECT_EQ(motion.v.leftCols(6), request.initial->v.leftCols(6));
    EXPECT_EQ(motion.q.col(30), request.q_goal);
    EXPECT_EQ(motion.v.col(30), Eigen::Vector2d::Zero());
    for (int k = 0; k < 31; ++k) {
      const Eigen::Vector2d moved = motion.q.col(k) - request.q_start;
      const double off_rad = std::abs(moved(0) * way(1) - moved(1) * way(0)) / way.norm();
      furthest_rad = std::max(furthest_rad, off_rad);
    }
  }
  EXPECT_GT(furthest_rad, 0.7);
  EXPECT_LT(furthest_rad, 4);
}

TEST(Detour, IsDecidedByItsStreamAlone) {
  RandomStream one(1, "test"), same(1, "test"), other(2, "test");
  const Trajectory motion = MakeDetour(Request(), Eigen::Vector2d::Ones(), one);
  EXPECT_EQ(motion.q, MakeDetour(Request(), Eigen::Vector2d::Ones(), same).q);
  EXPECT_NE(motion.q, MakeDetour(Request(), Eigen::Vector2d::Ones(), other).q);
}

TEST(Detour, OfAJointThatSlidesIsAsLongAsATurnMovesAForearm) {
  const auto made = [](double scale) {
    RandomStream random(1, "test");
    return MakeDetour(Request(), Eigen::Vector2d(scale, 1), random).q;
  };
  const Eigen::MatrixXd none = made(0), turns = made(1), slides = made(robot::kSlidePerTurn_m);
  EXPECT_GT((turns - none).row(0).norm(), 0.1);
  EXPECT_LT(((slides - none) - 0.25 * (turns - none)).row(0).norm(), 1e-12);
  EXPECT_EQ(slides.row(1), turns.row(1));
}

// The planar arm stays stretched along x.
Trajectory Rest() {
  return {Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Zero(2, 1), Eigen::MatrixXd::Zero(2, 1)};
}

TEST(Clearance, IsThatOfTheNearestSphereAtTheNearestTime) {
  const robot::RobotModel arm = MakePlanarArm();
  // The arm stays stretched along x; the ball passes 0.3 m beyond its tip at t = 1.
  const BallField field({1.3, -1, 0}, {0, 1, 0}, 0.1);
  const Trajectory rest = Rest();
  const EpisodeTime start(0);
  const auto least_m = [&](double from_s, double to_s) {
    return MeasureClearance(arm, field, rest, start, EpisodeTime(from_s), EpisodeTime(to_s))
        .least_m;
  };
  EXPECT_NEAR(least_m(0, 2), 0.3 - 0.1 - 0.04, 1e-9);
  EXPECT_NEAR(least_m(1.4, 2), std::hypot(0.3, 0.4) - 0.1 - 0.04, 1e-9);
  EXPECT_NEAR(least_m(0, 0.6), std::hypot(0.3, 0.4) - 0.1 - 0.04, 1e-9);
  EXPECT_NEAR(least_m(0.2, 0.2), std::hypot(0.3, 0.8) - 0.1 - 0.04, 1e-9);
}

TEST(Clearance, NamesTheFirstMomentAtWhichSomethingTouches) {
  const robot::RobotModel arm = MakePlanarArm();
  // The ball passes through the tip at t = 1, and touches it first 0.14 s earlier.
  const BallField field({1, -1, 0}, {0, 1, 0}, 0.1);
  const Trajectory rest = Rest();
  const EpisodeTime start(0);
  const Clearance touching = MeasureClearance(arm, field, rest, start, start, EpisodeTime(2));
  ASSERT_TRUE(touching.first_contact);
  EXPECT_NEAR(touching.first_contact->seconds(), 0.86 + 0.01, 0.011);
  EXPECT_FALSE(MeasureClearance(arm, field, rest, start, start, EpisodeTime(0.8)).first_contact);
}

TEST(IsSafer, PrefersWhatIsFreeThenWhatIsFreeForLongerThenWhatKeepsMoreDistance) {
  const Clearance wide{.least_m = 0.1, .first_contact = {}};
  const Clearance narrow{.least_m = 0.01, .first_contact = {}};
  const Clearance late{.least_m = -0.3, .first_contact = EpisodeTime(1.5)};
  const Clearance early{.least_m = -0.1, .first_contact = EpisodeTime(1.2)};
  const Clearance as_early{.least_m = -0.2, .first_contact = EpisodeTime(1.21)};
  const Clearance in_order[] = {wide, narrow, late, early, as_early};
  for (std::size_t i = 0; i < std::size(in_order); ++i) {
    for (std::size_t j = 0; j < std::size(in_order); ++j) {
      EXPECT_EQ(IsSafer(in_order[i], in_order[j]), i < j) << i << ", " << j;
    }
  }
}

TEST(Clearance, LeavesMountSpheresOut) {
  const robot::RobotModel arm = MakePlanarArm();
  const BallField at_base({0, 0, 0}, {0, 0, 0}, 0.05);
  const Trajectory rest = Rest();
  const EpisodeTime t(0);
  EXPECT_NEAR(MeasureClearance(arm, at_base, rest, t, t, t).least_m, 0.2 - 0.05 - 0.05, 1e-12);
}

TEST(LimitUse, IsThatOfTheCubicBetweenItsStates) {
  // From rest to rest over 1.8 rad in 1 s: 2.7 rad/s half way, 10.8 rad/s^2 at the ends. Limits of
  // the arm: 2.5 rad, 2 rad/s, 10 rad/s^2.
  const Trajectory motion{Eigen::Vector2d(0, 1),
                          (Eigen::MatrixXd(2, 2) << -0.2, 1.6, 0, 0).finished(),
                          Eigen::MatrixXd::Zero(2, 2)};
  const LimitUse use = MeasureLimitUse(MakePlanarArm(), motion, 0);
  EXPECT_NEAR(use.velocity, 2.7 / 2, 1e-12);
  EXPECT_NEAR(use.acceleration, 10.8 / 10, 1e-12);
  EXPECT_NEAR(use.position, 1.6 / 2.5, 1e-12);
  EXPECT_EQ(use.jerk, 0) << "the arm has no such limit";
  // The acceleration goes from 10.8 to -10.8 within the second.
  std::vector<robot::JointLimits> limits = MakePlanarArm().limits();
  limits[0].jerk_max = 54;
  EXPECT_NEAR(MeasureLimitUse(limits, motion, 0).jerk, 21.6 / 54, 1e-12);
  EXPECT_EQ(MeasureLimitUse(MakePlanarArm(), motion, 1).acceleration, 0);
}

}  // namespace
}  // namespace sidestep::planner::motion_test
