#include "sidestep/control/joint_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sidestep/core/random.h"

namespace sidestep::control::joint_motion_test {
namespace {

constexpr double kPeriod_s = 0.001;

// Motions and bounds of every kind that a tracker meets: with and against the motion, too fast to
// be stopped without swinging through, of more than the acceleration limit, with limits that are
// reached within a tick or after hundreds.
TEST(JointStop, IsWhatTheStopDoesTickByTick) {
  RandomStream random(1, "stops");
  for (int i = 0; i < 100000; ++i) {
    JointBounds bounds{-10, 10, 10, 0, 0};
    bounds.a_max = 10 * std::exp2(random.Uniform(-3, 3));
    bounds.jerk_max = bounds.a_max * 100 * std::exp2(random.Uniform(-5, 5));
    JointMotion motion{random.Uniform(-1, 1), 0, 0};
    const double kind = random.Uniform();
    motion.v = kind < 0.1 ? 0 : random.Uniform(-1, 1) * std::exp2(random.Uniform(-12, 2));
    motion.a = kind > 0.9 ? 0 : 1.5 * bounds.a_max * random.Uniform(-1, 1);

    const JointStop stop(motion, bounds, kPeriod_s);
    const double tolerance = 1e-11;
    double q_least = motion.q, q_most = motion.q, v_most = std::abs(motion.v);
    int ticks = 0;
    for (; motion.v != 0 || motion.a != 0; ++ticks) {
      ASSERT_NEAR(stop.PositionAfter(ticks), motion.q, tolerance) << i << " tick " << ticks;
      motion = motion.Next(BrakeAcceleration(motion, bounds, kPeriod_s), kPeriod_s);
      q_least = std::min(q_least, motion.q);
      q_most = std::max(q_most, motion.q);
      v_most = std::max(v_most, std::abs(motion.v));
    }
    ASSERT_NEAR(stop.q_end(), motion.q, tolerance) << i;
    ASSERT_NEAR(stop.PositionAfter(stop.ticks() + 5), motion.q, tolerance) << i;
    ASSERT_NEAR(stop.q_least(), q_least, tolerance) << i;
    ASSERT_NEAR(stop.q_most(), q_most, tolerance) << i;
    ASSERT_NEAR(stop.v_most(), v_most, tolerance) << i;
    ASSERT_NEAR(stop.ticks(), ticks, 2) << i;  // the last ones may move by a rounding error
  }
}

TEST(JointStop, OfAJointAtRestIsWhereItIs) {
  const JointStop stop({0.3, 0, 0}, {-1, 1, 2, 10, 1000}, kPeriod_s);
  EXPECT_EQ(stop.q_end(), 0.3);
  EXPECT_EQ(stop.q_least(), 0.3);
  EXPECT_EQ(stop.q_most(), 0.3);
  EXPECT_EQ(stop.v_most(), 0);
  EXPECT_EQ(stop.ticks(), 0);
}

}  // namespace
}  // namespace sidestep::control::joint_motion_test
