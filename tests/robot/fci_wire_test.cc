// The bytes on the wire, at the places that the protocol gives them.
#include <gtest/gtest.h>

#include <cstring>

#include "sidestep/robot/fci/errors.h"
#include "sidestep/robot/fci/wire.h"

namespace sidestep::robot::fci::fci_wire_test {
namespace {

template <typename Value>
void Put(Bytes& bytes, std::size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof(Value));
}

TEST(Wire, PutsEveryPartOfAStateInItsPlace) {
  RobotState state{};
  state.message_id = 0x0102030405060708;
  state.O_T_EE[15] = 1;
  state.tau_J[0] = 2;
  state.q[6] = 3;
  state.q_d[0] = 4;
  state.dq[0] = 5;
  state.ddq_d[0] = 6;
  state.tau_ext_hat_filtered[0] = 7;
  state.O_F_ext_hat_K[0] = 8;
  state.theta[0] = 9;
  state.motion_generator = MotionGenerator::kJointVelocity;
  state.controller = Controller::kOther;
  state.errors[40] = 1;
  state.reflex_reason[0] = 1;
  state.robot_mode = RobotMode::kReflex;
  state.success_rate = 0.75;
  Bytes expected(2373, 0);
  Put(expected, 0, std::uint64_t{0x0102030405060708});
  Put(expected, 8 + 15 * 8, 1.0);
  Put(expected, 1016, 2.0);
  Put(expected, 1184 + 6 * 8, 3.0);
  Put(expected, 1240, 4.0);
  Put(expected, 1296, 5.0);
  Put(expected, 1408, 6.0);
  Put(expected, 1672, 7.0);
  Put(expected, 1728, 8.0);
  Put(expected, 2168, 9.0);
  expected[2280] = 2;
  expected[2281] = 3;
  expected[2282 + 40] = 1;
  expected[2323] = 1;
  expected[2364] = 4;
  Put(expected, 2365, 0.75);
  const Bytes bytes = Encode(state);
  EXPECT_EQ(bytes, expected);
  EXPECT_EQ(bytes[0], 8) << "little-endian";
  EXPECT_EQ(Encode(DecodeRobotState(bytes)), bytes);
}

TEST(Wire, PutsEveryPartOfACommandInItsPlace) {
  RobotCommand command{};
  command.message_id = 77;
  command.q_c[0] = 1;
  command.dq_c[0] = 2;
  command.O_T_EE_c[0] = 3;
  command.elbow_c[1] = 4;
  command.valid_elbow = 1;
  command.motion_generation_finished = 1;
  command.tau_J_d[6] = 5;
  Bytes expected(370, 0);
  Put(expected, 0, std::uint64_t{77});
  Put(expected, 8, 1.0);
  Put(expected, 64, 2.0);
  Put(expected, 120, 3.0);
  Put(expected, 304, 4.0);
  expected[312] = 1;
  expected[313] = 1;
  Put(expected, 314 + 6 * 8, 5.0);
  const Bytes bytes = Encode(command);
  EXPECT_EQ(bytes, expected);
  EXPECT_EQ(Encode(DecodeRobotCommand(bytes)), bytes);
}

TEST(Wire, RefusesWhatHasAnotherSize) {
  EXPECT_THROW(DecodeRobotState(Bytes(2372)), std::invalid_argument);
  EXPECT_THROW(DecodeRobotCommand(Bytes(371)), std::invalid_argument);
  EXPECT_THROW(FromBytes<MoveRequest>(Bytes(55)), std::invalid_argument);
}

TEST(Wire, KnowsTheSizesOfRequestsAndReplies) {
  EXPECT_EQ(PayloadSize(Request::kMove), 56u);
  EXPECT_EQ(PayloadSize(Request::kSetCollisionBehavior), 416u);
  EXPECT_EQ(PayloadSize(Request::kSetGuidingMode), 7u);
  EXPECT_EQ(PayloadSize(Request::kStopMove), 0u);
  EXPECT_EQ(ConnectReply(1, 5), (Bytes{1, 5, 0}));
  EXPECT_EQ(NoCartesianLimit(0).size(), 154u);
}

// The order is the protocol's: a few of them, and that each name is one.
TEST(Errors, HaveTheirPlaces) {
  EXPECT_EQ(FindError("joint_position_limits_violation"), 0);
  EXPECT_EQ(FindError("joint_reflex"), static_cast<int>(Error::kJointReflex));
  EXPECT_EQ(FindError("joint_position_motion_generator_start_pose_invalid"),
            static_cast<int>(Error::kStartPoseInvalid));
  EXPECT_EQ(FindError("joint_motion_generator_acceleration_discontinuity"),
            static_cast<int>(Error::kAccelerationDiscontinuity));
  EXPECT_EQ(FindError("communication_constraints_violation"),
            static_cast<int>(Error::kCommunicationConstraintsViolation));
  EXPECT_EQ(FindError("controller_torque_discontinuity"),
            static_cast<int>(Error::kTorqueDiscontinuity));
  EXPECT_EQ(FindError("base_acceleration_invalid_reading"), kNumErrors - 1);
  EXPECT_FALSE(FindError("no_such_error"));
  for (int i = 0; i < kNumErrors; ++i) EXPECT_EQ(FindError(ErrorName(i)), i);
}

}  // namespace
}  // namespace sidestep::robot::fci::fci_wire_test
