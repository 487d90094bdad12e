// The small parts of the simulated robot server that need no arm: losses, modes, thresholds,
// faults.
#include <gtest/gtest.h>

#include <ostream>

#include "sidestep/core/input_error.h"
#include "sidestep/sim/fci/fault_player.h"
#include "sidestep/sim/fci/fault_script.h"
#include "sidestep/sim/fci/mode_machine.h"
#include "sidestep/sim/fci/packet_loss.h"
#include "sidestep/sim/fci/reflexes.h"

namespace sidestep::sim::fci::fci_parts_test {
namespace {

using robot::fci::Error;
using robot::fci::MoveStatus;
using robot::fci::RobotMode;

TEST(PacketLoss, EndsAMotionAtTwentyInARow) {
  PacketLoss loss;
  for (int burst = 0; burst < 3; ++burst) {
    for (int k = 0; k < 19; ++k) loss.Lost();
    EXPECT_FALSE(loss.are_too_many());
    loss.Received();
  }
  for (int k = 0; k < 20; ++k) loss.Lost();
  EXPECT_TRUE(loss.are_too_many());
}

TEST(PacketLoss, TellsTheSuccessOfTheLastHundred) {
  PacketLoss loss;
  EXPECT_EQ(loss.success_rate(), 0);
  loss.Received();
  EXPECT_EQ(loss.success_rate(), 1);
  loss.Lost();
  EXPECT_EQ(loss.success_rate(), 0.5);
  for (int k = 0; k < 99; ++k) loss.Received();
  EXPECT_EQ(loss.success_rate(), 0.99);  // the loss is the oldest
  loss.Received();
  EXPECT_EQ(loss.success_rate(), 1);
}

TEST(PacketLoss, TakesOnlyTheAnswerToTheLatestState) {
  EXPECT_TRUE(PacketLoss::IsInTime(7, 7));
  EXPECT_FALSE(PacketLoss::IsInTime(6, 7));
  EXPECT_FALSE(PacketLoss::IsInTime(8, 7));
}

robot::fci::MoveRequest Move(std::uint32_t controller, std::uint32_t generator) {
  return {controller, generator, {}, {}};
}

ModeMachine InMode(RobotMode mode) {
  ModeMachine modes;
  switch (mode) {
    case RobotMode::kMove:
      modes.StartMove(Move(0, 0));
      break;
    case RobotMode::kReflex:
      modes.Abort(robot::fci::Only(Error::kJointReflex));
      break;
    case RobotMode::kUserStopped:
      modes.PressUserStop();
      break;
    case RobotMode::kGuiding:
      modes.BeginGuiding();
      break;
    case RobotMode::kRecovery:
      modes.Abort(robot::fci::Only(Error::kJointReflex));
      modes.BeginRecovery(true);
      break;
    default:
      break;
  }
  return modes;
}

// What each mode answers to what a client may ask.
struct ModeCase {
  RobotMode mode;
  MoveStatus move;
  std::uint8_t stop, recover, set;  // 0: yes, 1: not possible
};
std::ostream& operator<<(std::ostream& stream, const ModeCase& test) {
  return stream << static_cast<int>(test.mode);
}

class EveryMode : public testing::TestWithParam<ModeCase> {};

TEST_P(EveryMode, AnswersWhatIsAskedOfIt) {
  const ModeCase& expected = GetParam();
  EXPECT_EQ(InMode(expected.mode).mode(), expected.mode);
  EXPECT_EQ(InMode(expected.mode).StartMove(Move(0, 1)), expected.move);
  EXPECT_EQ(InMode(expected.mode).StopMove(), expected.stop);
  EXPECT_EQ(InMode(expected.mode).BeginRecovery(true), expected.recover);
  EXPECT_EQ(InMode(expected.mode).MaySet(), expected.set);
}

INSTANTIATE_TEST_SUITE_P(
    Asked, EveryMode,
    testing::Values(ModeCase{RobotMode::kIdle, MoveStatus::kMotionStarted, 1, 0, 0},
                    ModeCase{RobotMode::kMove, MoveStatus::kNotPossible, 0, 1, 1},
                    ModeCase{RobotMode::kGuiding, MoveStatus::kNotPossible, 1, 1, 1},
                    ModeCase{RobotMode::kReflex, MoveStatus::kNotPossible, 1, 0, 1},
                    ModeCase{RobotMode::kUserStopped, MoveStatus::kNotPossible, 1, 1, 1},
                    ModeCase{RobotMode::kRecovery, MoveStatus::kNotPossible, 1, 1, 1}));

TEST(ModeMachine, StartsOnlyWhatIsSimulated) {
  for (std::uint32_t controller = 0; controller < 4; ++controller) {
    for (std::uint32_t generator = 0; generator < 5; ++generator) {
      ModeMachine modes;
      const MoveStatus expected = controller > 2 || generator > 3    ? MoveStatus::kInvalidArgument
                                  : controller != 1 && generator < 2 ? MoveStatus::kMotionStarted
                                                                     : MoveStatus::kNotPossible;
      EXPECT_EQ(modes.StartMove(Move(controller, generator)), expected)
          << controller << ", " << generator;
    }
  }
}

TEST(ModeMachine, EndsAMotionOnceWithTheStatusOfItsEnd) {
  const auto end_of = [](auto end) {
    ModeMachine modes = InMode(RobotMode::kMove);
    end(modes);
    EXPECT_EQ(modes.motion_generator(), robot::fci::MotionGenerator::kIdle);
    EXPECT_EQ(modes.controller(), robot::fci::Controller::kOther);
    const auto status = modes.TakeMoveEnd();
    EXPECT_FALSE(modes.TakeMoveEnd());
    return status;
  };
  EXPECT_EQ(end_of([](ModeMachine& m) { m.Finish(); }), MoveStatus::kSuccess);
  EXPECT_EQ(end_of([](ModeMachine& m) { m.StopMove(); }), MoveStatus::kPreempted);
  EXPECT_EQ(end_of([](ModeMachine& m) { m.Abort({}); }), MoveStatus::kReflexAborted);
  EXPECT_EQ(end_of([](ModeMachine& m) { m.PressUserStop(); }), MoveStatus::kEmergencyAborted);
  EXPECT_EQ(end_of([](ModeMachine& m) { m.AbortForBadInput(); }), MoveStatus::kInputErrorAborted);
  EXPECT_EQ(end_of([](ModeMachine& m) { m.BeginGuiding(); }), MoveStatus::kAborted);
}

TEST(ModeMachine, KeepsWhatEndedTheLastMotionUntilTheNext) {
  ModeMachine modes = InMode(RobotMode::kMove);
  const auto errors = robot::fci::Only(Error::kVelocityDiscontinuity);
  modes.Abort(errors);
  EXPECT_EQ(modes.errors(), errors);
  EXPECT_EQ(modes.BeginRecovery(true), robot::fci::status::kSuccess);
  modes.EndRecovery();
  EXPECT_EQ(modes.mode(), RobotMode::kIdle);
  EXPECT_TRUE(modes.errors().none());
  EXPECT_EQ(modes.last_motion_errors(), errors);
  modes.StartMove(Move(0, 0));
  EXPECT_TRUE(modes.last_motion_errors().none());
}

TEST(ModeMachine, SetsNoErrorAtAUserStopAndIsIdleAfterIt) {
  ModeMachine modes = InMode(RobotMode::kMove);
  modes.PressUserStop();
  EXPECT_TRUE(modes.errors().none());
  EXPECT_TRUE(modes.last_motion_errors().none());
  modes.Abort(robot::fci::Only(Error::kJointReflex));  // a stopped arm has no reflexes
  EXPECT_EQ(modes.mode(), RobotMode::kUserStopped);
  modes.ReleaseUserStop();
  EXPECT_EQ(modes.mode(), RobotMode::kIdle);
}

TEST(ModeMachine, DoesNotRecoverByItselfBeyondAJointLimit) {
  ModeMachine modes = InMode(RobotMode::kReflex);
  EXPECT_EQ(modes.BeginRecovery(false), robot::fci::status::kManualRecoveryRequired);
  EXPECT_EQ(modes.mode(), RobotMode::kReflex);
}

TEST(Reflexes, FollowTheThresholdsOfTheirPhase) {
  robot::fci::CollisionBehaviorRequest thresholds = DefaultCollisionBehavior();
  thresholds.lower_torque_nominal.fill(1);
  thresholds.upper_torque_nominal.fill(2);
  ExternalForce force;
  force.tau[3] = -1.5;
  EXPECT_EQ(FindContacts(force, thresholds, false).joint_contact[3], 1);
  EXPECT_TRUE(FindContacts(force, thresholds, false).reflexes.none());
  EXPECT_EQ(FindContacts(force, thresholds, true).joint_contact[3], 0);
  force.tau[3] = -2.5;
  EXPECT_EQ(FindContacts(force, thresholds, false).reflexes, robot::fci::Only(Error::kJointReflex));
  force = {};
  force.O_F_K[2] = 20.5;
  EXPECT_EQ(FindContacts(force, thresholds, false).reflexes,
            robot::fci::Only(Error::kCartesianReflex));
}

FaultPlayer Playing(const std::string& faults) {
  return FaultPlayer(ParseFaultScript("faults: [" + faults + "]", "f.yaml"));
}

TEST(FaultPlayer, LosesSoManyCommandsAndStates) {
  FaultPlayer player =
      Playing("{kind: lose_commands, at_s: 0.5, count: 3}, {kind: lose_states, at_s: 1, count: 2}");
  EXPECT_TRUE(player.Begin(0.499, {}).empty());
  EXPECT_FALSE(player.TakeLostCommand(0.499));
  player.Begin(0.5, {});
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(player.TakeLostCommand(0.5));
  EXPECT_FALSE(player.TakeLostCommand(0.5));
  player.Begin(1, {});
  for (int k = 0; k < 2; ++k) EXPECT_TRUE(player.TakeLostState());
  EXPECT_FALSE(player.TakeLostState());
}

TEST(FaultPlayer, LosesByChanceAtTheRateWhileItLasts) {
  FaultPlayer player = Playing("{kind: lose_some, at_s: 0, for_s: 1, rate: 0.05}");
  player.Begin(0, {});
  int lost = 0;
  for (int k = 0; k < 20000; ++k) lost += player.TakeLostCommand(0.5) ? 1 : 0;
  EXPECT_NEAR(lost, 1000, 4 * 31);  // four standard deviations
  for (int k = 0; k < 1000; ++k) ASSERT_FALSE(player.TakeLostCommand(1));
}

TEST(FaultPlayer, ActsOnTheJoints) {
  FaultPlayer player = Playing(
      "{kind: external_torque, at_s: 1, for_s: 2, joint: 1, rate_n_m_s: 5},"
      "{kind: friction, at_s: 1, for_s: 2, joint: 2, torque_n_m: 3},"
      "{kind: blocked_joint, at_s: 1, for_s: 2, joint: 3},"
      "{kind: tracking_offset, at_s: 1, for_s: 2, joint: 4, offset_rad: 0.02}");
  const robot::fci::Joints q = {0, 0, 0.3, 0, 0, 0, 0}, still{};
  player.Begin(1, q);
  const robot::fci::Joints motors = {0, 0, 7, 0, 0, 0, 0};
  robot::fci::Joints dq{};
  dq[1] = -0.5;
  const robot::fci::Joints torque = player.Disturbance(2, q, dq, motors);
  EXPECT_DOUBLE_EQ(torque[0], 5);
  EXPECT_EQ(torque[1], 3) << "against the motion";
  EXPECT_EQ(torque[2], -7) << "undoes the motor, where the joint is blocked";
  EXPECT_EQ(player.Disturbance(2, q, still, motors)[1], 0);
  EXPECT_EQ(player.Offset(2)[3], 0.02);
  EXPECT_EQ(player.Offset(3)[3], 0);
  EXPECT_EQ(player.Disturbance(3, q, dq, motors), still);
}

TEST(FaultPlayer, HandsOnWhatIsNotItsOwn) {
  FaultPlayer player = Playing(
      "{kind: cut_link, at_s: 2}, {kind: user_stop, at_s: 1, for_s: 1}, {kind: friction, at_s: 1,"
      " for_s: 1, joint: 1, torque_n_m: 1}");
  const std::vector<Fault> begun = player.Begin(1, {});
  ASSERT_EQ(begun.size(), 1u);
  EXPECT_EQ(begun[0].kind, FaultKind::kUserStop);
  EXPECT_TRUE(player.Begin(1.5, {}).empty());
  EXPECT_EQ(player.Begin(2.5, {}).at(0).kind, FaultKind::kCutLink);
}

TEST(FaultScript, IsReadWhole) {
  const FaultScript script = ParseFaultScript(R"(
version: 4
refuse_moves: 2
seed: 9
force_estimate: {per_speed_n_s_m: 40, per_acceleration_kg: 20}
faults:
  - {kind: lose_commands, at_s: 1, count: 19}
  - {kind: user_stop, at_s: 2.5, for_s: 0.5}
  - {kind: error, at_s: 3, name: power_limit_violation}
  - {kind: friction, at_s: 0, for_s: 9, joint: 7, torque_n_m: 3}
)",
                                              "faults.yaml");
  EXPECT_EQ(script.version, 4);
  EXPECT_EQ(script.refuse_moves, 2);
  EXPECT_EQ(script.force_per_speed_n_s_m, 40);
  EXPECT_EQ(script.force_per_acceleration_kg, 20);
  ASSERT_EQ(script.faults.size(), 4u);
  EXPECT_EQ(script.faults[0].count, 19);
  EXPECT_EQ(script.faults[1].duration_s, 0.5);
  EXPECT_EQ(robot::fci::ErrorName(script.faults[2].error), "power_limit_violation");
  EXPECT_EQ(script.faults[3].joint, 6);
  EXPECT_EQ(script.faults[3].torque_n_m, 3);
}

struct BadScript {
  std::string text, expected;
};
std::ostream& operator<<(std::ostream& stream, const BadScript& script) {
  return stream << script.expected;
}

class BadFaultScript : public testing::TestWithParam<BadScript> {};

TEST_P(BadFaultScript, IsRefusedWithItsLine) {
  try {
    ParseFaultScript(GetParam().text, "f.yaml");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), GetParam().expected);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadFaultScript,
    testing::Values(
        BadScript{"fault: []\n",
                  "f.yaml:1: fault: is not a known key (known here: faults, force_estimate, "
                  "refuse_moves, seed, version)"},
        BadScript{"faults:\n  - {kind: user_stop, at_s: 1, for_s: 1, count: 3}\n",
                  "f.yaml:2: faults[0].count: is not a known key (known here: at_s, for_s, kind)"},
        BadScript{"faults:\n  - {kind: lose_commands, at_s: -1, count: 3}\n",
                  "f.yaml:2: faults[0].at_s: must be >= 0, is -1"},
        BadScript{"faults:\n  - {kind: error, at_s: 1, name: joint_reflexes}\n",
                  "f.yaml:2: faults[0].name: no error of the robot is named 'joint_reflexes'"},
        BadScript{"faults:\n  - {kind: friction, at_s: 1, for_s: 1, joint: 8, torque_n_m: 1}\n",
                  "f.yaml:2: faults[0].joint: must be 1 to 7, is 8"},
        BadScript{"faults:\n  - {kind: lose_some, at_s: 1, for_s: 1, rate: 1.5}\n",
                  "f.yaml:2: faults[0].rate: must be 0 to 1"}));

}  // namespace
}  // namespace sidestep::sim::fci::fci_parts_test
