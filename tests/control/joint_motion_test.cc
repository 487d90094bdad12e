#include "sidestep/control/joint_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sidestep/core/random.h"

namespace sidestep::control {
namespace {

constexpr double kPeriod_s = 0.001;

// The stop, tick by tick.
StopSummary FollowStop(JointMotion motion, const JointBounds& bounds) {
  StopSummary stop = {motion.q, motion.q, motion.q, std::abs(motion.v)};
  while (motion.v != 0 || motion.a != 0) {
    motion = motion.Next(BrakeAcceleration(motion, bounds, kPeriod_s), kPeriod_s);
    stop.q_least = std::min(stop.q_least, motion.q);
    stop.q_most = std::max(stop.q_most, motion.q);
    stop.v_most = std::max(stop.v_most, std::abs(motion.v));
  }
  stop.q_end = motion.q;
  return stop;
}

// Motions and bounds of every kind that a tracker meets: with and against the motion, too fast to
// be stopped without swinging through, of more than the acceleration limit, with limits that are
// reached within a tick or after hundreds.
TEST(StopSummary, IsWhatTheStopDoesTickByTick) {
  RandomStream random(1, "stops");
  for (int i = 0; i < 100000; ++i) {
    JointBounds bounds{-10, 10, 10, 0, 0};
    bounds.a_max = 10 * std::exp2(random.Uniform(-3, 3));
    bounds.jerk_max = bounds.a_max * 100 * std::exp2(random.Uniform(-5, 5));
    JointMotion motion{random.Uniform(-1, 1), 0, 0};
    const double kind = random.Uniform();
    motion.v = kind < 0.1 ? 0 : random.Uniform(-1, 1) * std::exp2(random.Uniform(-12, 2));
    motion.a = kind > 0.9 ? 0 : 1.5 * bounds.a_max * random.Uniform(-1, 1);
    const StopSummary followed = FollowStop(motion, bounds);
    const StopSummary told = SummarizeStop(motion, bounds, kPeriod_s);
    const double tolerance = 1e-11;
    ASSERT_NEAR(told.q_end, followed.q_end, tolerance) << i;
    ASSERT_NEAR(told.q_least, followed.q_least, tolerance) << i;
    ASSERT_NEAR(told.q_most, followed.q_most, tolerance) << i;
    ASSERT_NEAR(told.v_most, followed.v_most, tolerance) << i;
  }
}

TEST(StopSummary, OfAJointAtRestIsWhereItIs) {
  const StopSummary stop = SummarizeStop({0.3, 0, 0}, {-1, 1, 2, 10, 1000}, kPeriod_s);
  EXPECT_EQ(stop.q_end, 0.3);
  EXPECT_EQ(stop.q_least, 0.3);
  EXPECT_EQ(stop.q_most, 0.3);
  EXPECT_EQ(stop.v_most, 0);
}

}  // namespace
}  // namespace sidestep::control
