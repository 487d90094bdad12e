#include "sidestep/planner/braking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/control/tracker.h"
#include "sidestep/core/random.h"
#include "sidestep/planner/limit_use.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::braking_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStep_s = 0.1;
constexpr int kNumStates = 31;

robot::JointLimits Joint(double q_max, double a_max) {
  return {-q_max, q_max, 2, a_max, kInfinity, kInfinity, kInfinity};
}

TrajectoryPoint From(const Eigen::Vector2d& q, const Eigen::Vector2d& v) { return {q, v, {}}; }

// When joint `j` comes to rest.
double StopTime(const Trajectory& motion, int j) {
  for (int k = 0; k < motion.num_states(); ++k) {
    if (std::abs(motion.v(j, k)) < 1e-12) return motion.t_s(k);
  }
  return kInfinity;
}

struct Stop {
  const char* name;
  robot::JointLimits joints[2];
  Eigen::Vector2d q, v;
  double stop_s[2];
};
std::ostream& operator<<(std::ostream& stream, const Stop& stop) { return stream << stop.name; }

class Braking : public ::testing::TestWithParam<Stop> {};

TEST_P(Braking, TakesTheTimeItShouldAndEndsWhereAConstantDecelerationLeads) {
  const Stop& stop = GetParam();
  const Trajectory motion =
      MakeBraking({stop.joints[0], stop.joints[1]}, From(stop.q, stop.v), kStep_s, kNumStates);
  ASSERT_NO_THROW(CheckTrajectory(motion));
  EXPECT_EQ(motion.q.col(0), stop.q);
  EXPECT_EQ(motion.v.col(0), stop.v);
  EXPECT_GE(motion.t_s(motion.num_states() - 1), 3.0 - 1e-9);
  for (int j = 0; j < 2; ++j) {
    if (stop.v(j) != 0) {
      EXPECT_NEAR(StopTime(motion, j), stop.stop_s[j], 1e-9) << "joint " << j;
    }
    EXPECT_NEAR(motion.q.rightCols<1>()(j), stop.q(j) + stop.v(j) * stop.stop_s[j] / 2, 1e-9);
    EXPECT_EQ(motion.v.rightCols<1>()(j), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Stops, Braking,
    ::testing::Values(
        // 1.5 / (0.9 * 10) = 0.167: two whole steps, for the slow joint too.
        Stop{"OneTimeForAll", {Joint(9, 10), Joint(9, 10)}, {0, 0}, {1.5, -0.1}, {0.2, 0.2}},
        Stop{"AtRest", {Joint(9, 10), Joint(9, 10)}, {0.3, 0}, {0, 0}, {0.1, 0.1}},
        // 0.08 rad are left and 1 rad/s stops in them within 0.16 s; both joints could.
        Stop{"OneShorterTimeBeforeALimit",
             {Joint(1, 10), Joint(9, 10)},
             {0.92, 0},
             {1, 0.5},
             {0.16, 0.16}},
        // The first needs 0.45 s, the second has room for 0.1 s.
        Stop{"EachItsOwnBeforeALimit",
             {Joint(9, 4), Joint(1, 40)},
             {0, 0.95},
             {1.8, 1},
             {0.5, 1 / 36.0}},
        // By its full deceleration of 10 it stops just there.
        Stop{"FullDecelerationBeforeALimit",
             {Joint(1, 10), Joint(9, 4)},
             {0.95, 0},
             {1, 1.8},
             {0.1, 0.5}},
        // It has no room at all.
        Stop{"BrokenLimit", {Joint(1, 10), Joint(9, 10)}, {0.99, 0}, {1, 0.9}, {0.1, 0.1}},
        Stop{"BeyondALimitAndBack", {Joint(1, 10), Joint(9, 10)}, {1.2, 0}, {-1, 0}, {0.2, 0.1}},
        Stop{"LongerThanTheHorizon",
             {Joint(99, 0.5), Joint(99, 10)},
             {0, 0},
             {1.75, 0.9},
             {3.9, 3.9}},
        Stop{"WithoutALimitOfAcceleration",
             {Joint(kInfinity, kInfinity), Joint(kInfinity, kInfinity)},
             {0, 0},
             {1.8, -0.9},
             {0.1, 0.1}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Braking, KeepsEveryLimitThatCanBeKeptAndTheDirectionWhereOneTimeCan) {
  RandomStream random(7, "braking");
  int together = 0, apart = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * random.Uniform();
    };
    const std::vector<robot::JointLimits> limits = {Joint(1, uniform(1, 20)),
                                                    Joint(1, uniform(1, 20))};
    const Eigen::Vector2d q(uniform(-1, 1), uniform(-1, 1)), v(uniform(-2, 2), uniform(-2, 2));
    const Trajectory motion =
        MakeBraking(limits, From(q, v), kStep_s, static_cast<int>(uniform(2, 31)));
    EXPECT_LE(MeasureLimitUse(limits, motion, 0).acceleration, 1 + 1e-6) << i;
    double least_s = 0, most_s = kInfinity;  // of one time for all
    for (int j = 0; j < 2; ++j) {
      const double a_max = limits[static_cast<std::size_t>(j)].a_max, speed = std::abs(v(j));
      const double room = 1 - std::copysign(q(j), q(j) * v(j));
      if (speed * speed / (2 * a_max) <= room) {
        EXPECT_LE(motion.q.row(j).cwiseAbs().maxCoeff(), 1 + 1e-9) << i << ", joint " << j;
      }
      least_s = std::max({least_s, speed / a_max, 0.01});
      most_s = std::min(most_s, 2 * room / speed);
    }
    const Eigen::Vector2d way = motion.q.rightCols<1>() - q;
    const double off = std::abs(way(0) * v(1) - way(1) * v(0)) / v.norm();
    if (least_s <= most_s) {
      EXPECT_LT(off, 1e-9) << i;
    }
    (least_s <= most_s ? together : apart) += 1;
  }
  EXPECT_GT(together, 100);
  EXPECT_GT(apart, 100);
}

// What is judged is the plan; what is executed is what the tracker makes of it, from a motion that
// was just being accelerated.
TEST(Braking, IsFollowedByTheTrackerToTheMillimetre) {
  const robot::RobotModel arm = MakePlanarArm();
  const Eigen::Vector2d q(0.3, -0.4), v(1.8, -0.7), a(5, -5);
  const control::JerkLimitedTracker tracker(control::TrackerLimits::Of(arm));
  control::JointPoint command = {q, v, a};
  const Trajectory motion = MakeBraking(arm.limits(), From(q, v), kStep_s, kNumStates);
  double worst_rad = 0;
  for (int tick = 1; tick <= 1000; ++tick) {
    const TrajectoryPoint target = Sample(motion, HorizonOffset(0.001 * tick));
    command = tracker.Step(command, {target.q, target.v, target.a}, 0.001);
    worst_rad = std::max(worst_rad, (command.q - target.q).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst_rad, 1e-3);
}

}  // namespace
}  // namespace sidestep::planner::braking_test
