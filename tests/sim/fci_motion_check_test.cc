// The documented checks of a commanded motion, as pure functions.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>

#include "sidestep/core/random.h"
#include "sidestep/sim/fci/controller.h"
#include "sidestep/sim/fci/motion_check.h"

namespace sidestep::sim::fci::fci_motion_check_test {
namespace {

using robot::fci::Error;
using robot::fci::ErrorSet;
using robot::fci::Joints;

constexpr double kEps = 1e-9;

JointTable PandaLimits() {
  const robot::RobotModel panda =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  JointTable limits;
  for (std::size_t i = 0; i < limits.size(); ++i) limits[i] = panda.limits()[i];
  return limits;
}

Reference AtRest() {
  Reference reference;
  reference.q = {0, -0.785, 0, -2.356, 0, 1.57, 0.785};
  return reference;
}

// One step of joint 2 (a_max 7.5, jerk_max 3750), from a state of it.
struct StepCase {
  std::string name;
  double dq = 0, ddq = 0;  // before
  double dq_c = 0;         // commanded velocity
  std::string expected;
};
std::ostream& operator<<(std::ostream& stream, const StepCase& step) { return stream << step.name; }

class Step : public testing::TestWithParam<StepCase> {};

TEST_P(Step, IsNamedAfterAllThatItBreaks) {
  Reference before = AtRest();
  before.dq[1] = GetParam().dq;
  before.ddq[1] = GetParam().ddq;
  Joints dq_c{};
  dq_c[1] = GetParam().dq_c;
  const ErrorSet errors = CheckStep(before, FollowVelocities(before, dq_c), PandaLimits());
  EXPECT_EQ(robot::fci::Text(errors), GetParam().expected);
}

const std::string kV = "joint_motion_generator_velocity_limits_violation";
const std::string kA = "joint_motion_generator_velocity_discontinuity";
const std::string kJ = "joint_motion_generator_acceleration_discontinuity";

INSTANTIATE_TEST_SUITE_P(
    Limits, Step,
    testing::Values(StepCase{"Rest", 0, 0, 0, "none"},
                    StepCase{"JerkJustInside", 0, 0, 3.75e-3 * (1 - kEps), "none"},
                    StepCase{"JerkAtItsLimit", 0, 0, 3.75e-3 * (1 + kEps), kJ},
                    StepCase{"AccelerationJustInside", 0, 7.4, 7.5e-3 * (1 - kEps), "none"},
                    StepCase{"AccelerationAtItsLimit", 0, 7.4, 7.5e-3 * (1 + kEps), kA},
                    StepCase{"VelocityJustInside", 2.175 * (1 - kEps), 0, 2.175 * (1 - kEps),
                             "none"},
                    StepCase{"VelocityAtItsLimit", 2.175 * (1 - kEps), 0, 2.175, kV},
                    StepCase{"AJump", 0, 0, 10, kV + ", " + kA + ", " + kJ},
                    StepCase{"NotANumber", 0, 0, std::nan(""),
                             "joint_motion_generator_position_limits_violation, " + kV + ", " + kA +
                                 ", " + kJ}),
    [](const auto& test) { return test.param.name; });

TEST(MotionCheck, NamesAPositionLimit) {
  const JointTable limits = PandaLimits();
  for (const double side : {-1, 1}) {
    Reference before = AtRest();
    before.q[6] = side * (limits[6].q_max - 1e-6);
    before.dq[6] = side * 0.002;
    const ErrorSet errors = CheckStep(before, Extrapolate(before), limits);
    EXPECT_EQ(errors, robot::fci::Only(Error::kPositionLimitsViolation));
  }
}

// Backward Euler undoes what makes it: positions that come from velocities give these velocities.
TEST(MotionCheck, SeesPositionsAndVelocitiesAlike) {
  RandomStream random(1, "motion");
  Reference by_velocity = AtRest(), by_position = AtRest();
  for (int k = 0; k < 1000; ++k) {
    Joints dq;
    for (double& value : dq) value = random.Uniform(-1, 1);
    by_velocity = FollowVelocities(by_velocity, dq);
    by_position = FollowPositions(by_position, by_velocity.q);
    for (std::size_t i = 0; i < dq.size(); ++i) {
      ASSERT_NEAR(by_position.dq[i], dq[i], 1e-11);
      ASSERT_NEAR(by_position.ddq[i], by_velocity.ddq[i], 1e-8);
    }
  }
}

// Whatever keeps the table is let through, whatever breaks it is not: against the definition.
TEST(MotionCheck, AgreesWithTheDefinitionAtRandomSteps) {
  const JointTable limits = PandaLimits();
  RandomStream random(7, "steps");
  int refused = 0;
  for (int k = 0; k < 20000; ++k) {
    Reference before = AtRest();
    Joints jerk;
    bool keeps = true;
    for (std::size_t i = 0; i < jerk.size(); ++i) {
      before.ddq[i] = random.Uniform(-1, 1) * limits[i].a_max;
      before.dq[i] = random.Uniform(-1, 1) * limits[i].v_max;
      jerk[i] = random.Uniform(-1.02, 1.02) * limits[i].jerk_max;
    }
    Joints dq_c;
    for (std::size_t i = 0; i < jerk.size(); ++i) {
      const double ddq = before.ddq[i] + jerk[i] * kTick_s;
      dq_c[i] = before.dq[i] + ddq * kTick_s;
      keeps = keeps && std::abs(jerk[i]) < limits[i].jerk_max && std::abs(ddq) < limits[i].a_max &&
              std::abs(dq_c[i]) < limits[i].v_max;
    }
    refused += keeps ? 0 : 1;
    ASSERT_EQ(CheckStep(before, FollowVelocities(before, dq_c), limits).none(), keeps) << k;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 19000);
}

TEST(MotionCheck, LetsAMotionBeginOnlyWhereTheRobotIs) {
  const JointTable limits = PandaLimits();
  Joints q = AtRest().q;
  EXPECT_TRUE(CheckStart(q, AtRest().q, limits).none());
  q[3] += 0.01;
  EXPECT_EQ(CheckStart(q, AtRest().q, limits), robot::fci::Only(Error::kStartPoseInvalid));
}

TEST(MotionCheck, LetsAMotionEndOnlyNearlyAtRest) {
  const JointTable limits = PandaLimits();
  Reference last = AtRest();
  EXPECT_TRUE(CheckEnd(last, limits).none());
  last.dq[1] = 0.003;  // to rest in a tick: 3 rad/s^2, and 3000 rad/s^3 twice
  EXPECT_TRUE(CheckEnd(last, limits).none());
  last.dq[1] = 0.1;
  EXPECT_TRUE(robot::fci::Holds(CheckEnd(last, limits), Error::kVelocityDiscontinuity));
}

TEST(MotionCheck, ExtrapolatesWithConstantAcceleration) {
  Reference reference = AtRest();
  reference.dq[0] = 0.5;
  reference.ddq[0] = 2;
  const double q0 = reference.q[0];
  for (int k = 0; k < 19; ++k) reference = Extrapolate(reference);
  EXPECT_NEAR(reference.dq[0], 0.5 + 2 * 0.019, 1e-12);
  EXPECT_NEAR(reference.q[0] - q0, 0.5 * 0.019 + 2 * 1e-6 * (19 * 20 / 2), 1e-12);
  EXPECT_EQ(reference.ddq[0], 2);
}

TEST(MotionCheck, BrakesAtTheGreatestAcceleration) {
  const JointTable limits = PandaLimits();
  Reference reference = AtRest();
  reference.dq = {2, -2, 2, -2, 2, -2, 2};
  int ticks = 0;
  while (!IsAtRest(reference)) {
    reference = Brake(reference, limits);
    for (std::size_t i = 0; i < limits.size(); ++i) {
      ASSERT_LE(std::abs(reference.ddq[i]), limits[i].a_max * (1 + 1e-9));
    }
    ++ticks;
  }
  EXPECT_NEAR(ticks, 2 / 7.5 / kTick_s, 2);  // joint 2 is the last
}

TEST(Controller, RefusesATorqueThatJumps) {
  const JointTable limits = PandaLimits();
  Joints torque{};
  torque[2] = 0.999;
  EXPECT_TRUE(CheckTorque({}, torque, limits).none());
  torque[2] = 1.001;  // a tick of 1000 N m/s
  EXPECT_EQ(CheckTorque({}, torque, limits), robot::fci::Only(Error::kTorqueDiscontinuity));
  torque[2] = std::nan("");
  EXPECT_EQ(CheckTorque({}, torque, limits), robot::fci::Only(Error::kTorqueDiscontinuity));
}

}  // namespace
}  // namespace sidestep::sim::fci::fci_motion_check_test
