// The bare protocol client against the simulated robot server, over the loopback, in lock-step.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <thread>

#include "sidestep/hardware/raw_fci_driver.h"
#include "tests/hardware/served_panda.h"

namespace sidestep::hardware::fci_server_test {
namespace {

using robot::fci::Error;
using robot::fci::Joints;
using robot::fci::RobotMode;
using Kind = FciError::Kind;

// A motion of positions: so many joints, there and back within two seconds, at rest at both ends.
class Swing {
 public:
  explicit Swing(double amplitude_rad = 0.2, int length_ms = 2000)
      : amplitude_rad_(amplitude_rad), length_ms_(length_ms) {}

  Command operator()(const RobotSnapshot& state, int elapsed_ms) {
    if (time_ms_ == 0 && elapsed_ms == 0) start_ = state.q_d;
    time_ms_ += elapsed_ms;
    // Smooth to the jerk: sin^4.
    const double s = std::sin(M_PI * std::min(time_ms_, length_ms_) / length_ms_);
    Command command{start_, time_ms_ >= length_ms_};
    for (const std::size_t i : {0, 3, 6}) command.values[i] += amplitude_rad_ * std::pow(s, 4);
    return command;
  }
  int time_ms() const { return time_ms_; }

 private:
  double amplitude_rad_;
  int length_ms_;
  int time_ms_ = 0;
  Joints start_{};
};

constexpr int kFarTooLong = 200000;  // ms: where a motion that must be ended by others ends

// Runs a motion that must fail.
FciError FailureOf(FciDriver& driver, CommandKind kind, const FciDriver::NextCommand& next) {
  try {
    driver.Control(kind, next);
  } catch (const FciError& error) {
    return error;
  }
  ADD_FAILURE() << "the motion ended as if nothing had been";
  return FciError(Kind::kAborted, "");
}

TEST(FciServer, RunsAMotionAndIsIdleAfterIt) {
  const ServedPanda panda;
  RawFciDriver driver(panda.address());
  EXPECT_EQ(driver.server_version(), 5);
  const RobotSnapshot before = driver.ReadOnce();
  EXPECT_EQ(before.mode, RobotMode::kIdle);
  EXPECT_EQ(before.success_rate, 0);
  Swing swing;
  double largest_error = 0, least_success = 1;
  driver.Control(CommandKind::kPositions, [&](const RobotSnapshot& state, int elapsed_ms) {
    EXPECT_EQ(elapsed_ms, swing.time_ms() == 0 && elapsed_ms == 0 ? 0 : 1);
    EXPECT_EQ(state.mode, RobotMode::kMove);
    for (std::size_t i = 0; i < state.q.size(); ++i) {
      largest_error = std::max(largest_error, std::abs(state.q[i] - state.q_d[i]));
    }
    if (elapsed_ms > 0) least_success = std::min(least_success, state.success_rate);
    return swing(state, elapsed_ms);
  });
  EXPECT_EQ(least_success, 1);
  EXPECT_GT(largest_error, 1e-5) << "the arm is no ghost";
  EXPECT_LT(largest_error, 0.02);
  const RobotSnapshot after = driver.ReadOnce();
  EXPECT_EQ(after.mode, RobotMode::kIdle);
  EXPECT_TRUE(after.last_motion_errors.none());
  for (std::size_t i = 0; i < after.q.size(); ++i) {
    EXPECT_NEAR(after.q_d[i], before.q_d[i], 1e-12);
    EXPECT_NEAR(after.q[i], before.q[i], 2e-3);
  }
}

TEST(FciServer, KnowsWhereTheHandIs) {
  const ServedPanda panda;
  RawFciDriver driver(panda.address());
  const RobotSnapshot state = driver.ReadOnce();
  const Eigen::VectorXd home = panda.robot().configurations().at("home");
  // The frame after the last row of robot.yaml is the hand's, 0.1034 m from its tip.
  const Pose X_WH = panda.robot().ComputeLinkPoses(home).back();
  const Eigen::Vector3d tip = X_WH * Eigen::Vector3d(0, 0, 0.1034);
  const Eigen::Matrix3d R = X_WH.rotation().toRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    EXPECT_NEAR(state.O_T_EE[static_cast<std::size_t>(12 + row)], tip(row), 1e-9);
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR(state.O_T_EE[static_cast<std::size_t>(4 * column + row)], R(row, column), 1e-9);
    }
  }
}

// Thirty seconds of the robot's time take little of ours, and nothing is lost.
TEST(FciServer, FeelsTheArmsWeightBeforeItHasMoved) {
  const ServedPanda panda;
  RawFciDriver driver(panda.address());
  const Joints before = driver.ReadOnce().tau_J;
  driver.Control(CommandKind::kPositions, Swing(0, 20));  // stays where it is
  const Joints after = driver.ReadOnce().tau_J;
  EXPECT_GT(std::abs(before[3]), 5);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 0.01);
}

TEST(FciServer, LosesNothingInThirtySeconds) {
  const ServedPanda panda;
  RawFciDriver driver(panda.address());
  Swing swing(0.5, 30000);
  int calls = 0;
  driver.Control(CommandKind::kPositions, [&](const RobotSnapshot& state, int elapsed_ms) {
    ++calls;
    return swing(state, elapsed_ms);
  });
  EXPECT_EQ(calls, 30001);
}

// What goes wrong, and what it must be called. Joint 2 has the tightest limits: 2.175 rad/s,
// 7.5 rad/s^2, 3750 rad/s^3.
struct AbortCase {
  std::string name;
  std::string faults;
  CommandKind kind = CommandKind::kPositions;
  std::function<double(int time_ms)> joint;  // commands one: position from the start, or velocity
  std::string expected;
  std::size_t index = 1;       // which
  double force_threshold = 0;  // if not the default, of all six
  bool recovers = true;        // by itself
};
std::ostream& operator<<(std::ostream& stream, const AbortCase& test) {
  return stream << test.name;
}

FciSettings Thresholds(double force) {
  FciSettings settings;
  settings.stiffness = {3000, 3000, 3000, 2500, 2500, 2000, 2000};
  settings.collision = sim::fci::DefaultCollisionBehavior();
  for (robot::fci::Wrench* wrench :
       {&settings.collision.upper_force_acceleration, &settings.collision.upper_force_nominal}) {
    wrench->fill(force);
  }
  return settings;
}

class Abort : public testing::TestWithParam<AbortCase> {};

TEST_P(Abort, HasItsNameAndIsRecovered) {
  const AbortCase& test = GetParam();
  const ServedPanda panda(test.faults);
  RawFciDriver driver(panda.address());
  if (test.force_threshold > 0) driver.Configure(Thresholds(test.force_threshold));
  int time_ms = 0;
  Joints start{};
  const FciError error =
      FailureOf(driver, test.kind, [&](const RobotSnapshot& state, int elapsed_ms) {
        if (time_ms == 0) start = state.q_d;
        time_ms += elapsed_ms;
        Command command;
        if (test.kind == CommandKind::kPositions) command.values = start;
        command.values[test.index] += test.joint(time_ms);
        command.finished = time_ms >= 8000;
        return command;
      });
  EXPECT_EQ(error.kind(), Kind::kReflex) << error.what();
  EXPECT_EQ(robot::fci::Text(error.errors()), test.expected);
  ASSERT_FALSE(error.log().empty());
  EXPECT_LE(error.log().size(), 50u);
  EXPECT_EQ(error.log().back().state.mode, RobotMode::kMove);

  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kReflex);
  EXPECT_EQ(robot::fci::Text(driver.ReadOnce().last_motion_errors), test.expected);
  EXPECT_EQ(FailureOf(driver, CommandKind::kPositions, Swing()).kind(), Kind::kRefused);
  if (!test.recovers) {
    EXPECT_THROW(driver.Recover(), FciError);
    return;
  }
  driver.Recover();
  const RobotSnapshot recovered = driver.ReadOnce();
  EXPECT_EQ(recovered.mode, RobotMode::kIdle);
  EXPECT_TRUE(recovered.errors.none());
}

const std::string kV = "joint_motion_generator_velocity_limits_violation";
const std::string kA = "joint_motion_generator_velocity_discontinuity";
const std::string kJ = "joint_motion_generator_acceleration_discontinuity";
const std::string kLost = "communication_constraints_violation";

double Nothing(int) { return 0; }
// Velocity that grows by `step` each ms from 100 ms on, for so many ms.
std::function<double(int)> Ramp(double step, int length_ms) {
  return [=](int t) { return step * std::clamp(t - 100, 0, length_ms); };
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Abort,
    testing::Values(
        AbortCase{"JumpOfThePosition", "", CommandKind::kPositions,
                  [](int ms) { return ms > 100 ? 0.01 : 0; }, kV + ", " + kA + ", " + kJ},
        AbortCase{"StartElsewhere", "", CommandKind::kPositions, [](int) { return 0.01; },
                  "joint_position_motion_generator_start_pose_invalid"},
        AbortCase{"JerkAtTheStart", "", CommandKind::kPositions, [](int) { return 4e-6; }, kJ},
        AbortCase{"TooMuchJerk", "", CommandKind::kVelocities, Ramp(0.004, 1), kJ},
        AbortCase{"TooMuchAcceleration", "", CommandKind::kVelocities,
                  [](int ms) {  // 3, 6, 9 rad/s^2
                    const int k = std::clamp(ms - 100, 0, 3);
                    return 0.003 * k * (k + 1) / 2;
                  },
                  kA},
        AbortCase{"TooFast", "", CommandKind::kVelocities, Ramp(0.0035, 1000), kV},
        AbortCase{"BeyondAPosition", "", CommandKind::kVelocities, Ramp(0.0035, 200),
                  "joint_motion_generator_position_limits_violation", 6, 0, false},
        AbortCase{"BeyondAPositionAtAnotherPace", "", CommandKind::kVelocities, Ramp(0.003, 234),
                  "joint_motion_generator_position_limits_violation", 6, 0, false},
        AbortCase{"TorqueIntoALimit", "", CommandKind::kTorques, Ramp(0.005, 200),
                  "joint_position_limits_violation", 6, 0, false},
        AbortCase{"EndInMotion", "", CommandKind::kVelocities,
                  [](int ms) { return 0.0001 * std::max(0, ms - 7000); }, kA + ", " + kJ},
        AbortCase{"JumpOfATorque", "", CommandKind::kTorques,
                  [](int ms) { return ms > 100 ? 2 : 0; }, "controller_torque_discontinuity"},
        AbortCase{"TwentyCommandsLost", "faults: [{kind: lose_commands, at_s: 0.5, count: 20}]",
                  CommandKind::kPositions, Nothing, kLost},
        AbortCase{"TwentyStatesLost", "faults: [{kind: lose_states, at_s: 0.5, count: 20}]",
                  CommandKind::kPositions, Nothing, kLost},
        AbortCase{"AReflexAtATime",
                  "faults: [{kind: error, at_s: 0.5, name: self_collision_avoidance_violation}]",
                  CommandKind::kPositions, Nothing, "self_collision_avoidance_violation"},
        AbortCase{"APushOnAJoint",
                  "faults: [{kind: external_torque, at_s: 0.5, for_s: 9, joint: 7, rate_n_m_s: 5}]",
                  CommandKind::kPositions, Nothing, "joint_reflex", 1, 1000},
        AbortCase{"ABlockedJoint", "faults: [{kind: blocked_joint, at_s: 0.2, for_s: 9, joint: 2}]",
                  CommandKind::kVelocities, Ramp(0.001, 300), "joint_reflex", 1, 1000},
        // As a real one does above some 1 m/s^2 of the tool.
        AbortCase{"AForceThatOnlySeemsToBe",
                  "force_estimate: {per_speed_n_s_m: 0, per_acceleration_kg: 20}",
                  CommandKind::kVelocities, Ramp(0.005, 300), "cartesian_reflex", 0}),
    [](const auto& test) { return test.param.name; });

// What a robot takes without a word.
class Harmless : public testing::TestWithParam<std::string> {};

TEST_P(Harmless, DoesNotEndAMotion) {
  const ServedPanda panda(GetParam());
  RawFciDriver driver(panda.address());
  driver.Control(
      CommandKind::kVelocities, [time_ms = 0](const RobotSnapshot& state, int elapsed_ms) mutable {
        time_ms += elapsed_ms;
        Command command;
        // A jerk-limited client: it goes on from what the robot follows, and so takes losses
        // smoothly.
        const double wanted = time_ms < 1500 ? 0.2 : 0;
        const double next = state.dq_d[0] + std::clamp(wanted - state.dq_d[0], -1e-3, 1e-3);
        command.values[0] = next;
        command.finished = time_ms > 2500;
        return command;
      });
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kIdle);
}

INSTANTIATE_TEST_SUITE_P(
    Losses, Harmless,
    testing::Values(
        "faults: [{kind: lose_commands, at_s: 1, count: 19}]",
        "faults: [{kind: lose_commands, at_s: 0, count: 30}]",  // the motion has not begun
        "faults: [{kind: lose_states, at_s: 1, count: 8}]",
        "faults: [{kind: lose_some, at_s: 0.5, for_s: 0.5, rate: 0.05}]",
        "faults: [{kind: tracking_offset, at_s: 1, for_s: 1, joint: 2, offset_rad: 0.002}]",
        "faults: [{kind: friction, at_s: 0, for_s: 9, joint: 1, torque_n_m: 4}]"),
    [](const auto& test) { return "Case" + std::to_string(test.index); });

TEST(FciServer, ShowsLostStatesAsAGapAndInTheSuccessRate) {
  const ServedPanda panda("faults: [{kind: lose_states, at_s: 0.5, count: 8}]");
  RawFciDriver driver(panda.address());
  int longest = 0;
  double least = 1;
  Swing swing(0, 1000);
  driver.Control(CommandKind::kPositions, [&](const RobotSnapshot& state, int elapsed_ms) {
    longest = std::max(longest, elapsed_ms);
    if (elapsed_ms > 0) least = std::min(least, state.success_rate);
    return swing(state, elapsed_ms);
  });
  EXPECT_EQ(longest, 9);
  EXPECT_NEAR(least, 0.92, 1e-9);
}

TEST(FciServer, TurnsAwayWhoDoesNotSpeakItsProtocol) {
  const ServedPanda panda;
  {
    auto link = robot::fci::CommandLink::Connect(panda.address(), robot::fci::kCommandPort,
                                                 std::chrono::seconds(1));
    link.Send({robot::fci::Request::kMove, 1, {}});
    EXPECT_THROW(
        {
          robot::fci::WaitToRead({link.fd()}, std::chrono::seconds(10));
          link.Receive();
        },
        robot::fci::LinkClosed);
  }
  const RawFciDriver driver(panda.address());
  EXPECT_EQ(driver.server_version(), 5);
}

TEST(FciServer, IsStoppedByTheUserAndFreeAgainAfterwards) {
  const ServedPanda panda("faults: [{kind: user_stop, at_s: 0.5, for_s: 2}]");
  RawFciDriver driver(panda.address());
  const FciError error = FailureOf(driver, CommandKind::kPositions, Swing());
  EXPECT_EQ(error.kind(), Kind::kUserStop);
  EXPECT_TRUE(error.errors().none());
  EXPECT_EQ(error.log().size(), 50u);
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kUserStopped);
  EXPECT_EQ(FailureOf(driver, CommandKind::kPositions, Swing()).kind(), Kind::kRefused);
  EXPECT_THROW(driver.Recover(), FciError);
  while (driver.ReadOnce().mode == RobotMode::kUserStopped) {
  }
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kIdle);
  driver.Control(CommandKind::kPositions, Swing());
}

// The robot's clock goes on when nobody is connected.
TEST(FciServer, LetsGoOfAStopWithoutAClient) {
  const ServedPanda panda("faults: [{kind: user_stop, at_s: 0.1, for_s: 1.5}]");
  {
    RawFciDriver driver(panda.address());
    EXPECT_EQ(FailureOf(driver, CommandKind::kPositions, Swing()).kind(), Kind::kUserStop);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  RawFciDriver driver(panda.address());
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kIdle);
}

TEST(FciServer, TurnsAwayWhoComesWhileAnotherOneIsConnected) {
  const ServedPanda panda;
  auto first = std::make_unique<RawFciDriver>(panda.address());
  for (int attempt = 0; attempt < 3; ++attempt) {
    try {
      const RawFciDriver second(panda.address());
      FAIL() << "was connected";
    } catch (const FciError& error) {
      EXPECT_EQ(error.kind(), Kind::kNetwork);
      EXPECT_NE(std::string(error.what()).find("another program may be connected"),
                std::string::npos)
          << error.what();
    }
  }
  first->Control(CommandKind::kPositions, Swing());
  // One after the other, however soon.
  for (int k = 0; k < 20; ++k) {
    first.reset();
    first = std::make_unique<RawFciDriver>(panda.address());
    EXPECT_EQ(first->ReadOnce().mode, RobotMode::kIdle);
  }
}

TEST(World, BeginsAnewWithTheArmWhereItIs) {
  scenarios::Scenario scenario = sim::fci::PandaAlone();
  scenario.moving_obstacles.emplace_back();
  scenario.moving_obstacles.back().name = "ball";
  scenario.moving_obstacles.back().shape = Sphere{0.1};
  scenario.moving_obstacles.back().rpy_rad.setZero();
  scenario.moving_obstacles.back().motion = scenarios::LinearMotion{{0, 2, 1}, {0, 1, 0}, 1, 100};
  const std::string models = SIDESTEP_SOURCE_DIR "/models";
  const robot::RobotModel robot = robot::RobotModel::Load(models, "panda", Pose());
  const auto world =
      sim::fci::MakePandaWorld(scenario, robot, models, robot.configurations().at("home"));
  const auto ball_y = [&] { return world->data().mocap_pos[1]; };
  for (int k = 0; k < 500; ++k) world->Step(Eigen::VectorXd::Constant(7, 1));
  EXPECT_NEAR(ball_y(), 2.5, 1e-9);
  const Eigen::VectorXd q = world->q();
  world->BeginAnew();
  EXPECT_EQ(world->time(), EpisodeTime(0));
  EXPECT_EQ(ball_y(), 2);
  EXPECT_EQ(world->q(), q);
  EXPECT_TRUE(world->v().isZero(0));
}

TEST(FciServer, IsTakenByTheHand) {
  const ServedPanda panda("faults: [{kind: guiding, at_s: 0.5, for_s: 1}]");
  RawFciDriver driver(panda.address());
  EXPECT_EQ(FailureOf(driver, CommandKind::kPositions, Swing()).kind(), Kind::kAborted);
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kGuiding);
}

TEST(FciServer, RefusesAnotherVersion) {
  const ServedPanda panda("version: 6");
  try {
    const RawFciDriver driver(panda.address());
    FAIL() << "was connected";
  } catch (const FciError& error) {
    EXPECT_EQ(error.kind(), Kind::kVersion);
    EXPECT_NE(std::string(error.what()).find("version 6 of the protocol, this program 5"),
              std::string::npos)
        << error.what();
  }
}

TEST(FciServer, RefusesSoManyMoves) {
  const ServedPanda panda("refuse_moves: 2");
  RawFciDriver driver(panda.address());
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(FailureOf(driver, CommandKind::kPositions, Swing()).kind(), Kind::kRefused);
  }
  driver.Control(CommandKind::kPositions, Swing());
}

TEST(FciServer, GoesWhenTheLinkIsCutAndIsInAReflexAfterwards) {
  const ServedPanda panda("faults: [{kind: cut_link, at_s: 0.5}]");
  RawFciDriver driver(panda.address());
  EXPECT_EQ(FailureOf(driver, CommandKind::kPositions, Swing()).kind(), Kind::kNetwork);
  RawFciDriver next(panda.address());
  EXPECT_EQ(next.ReadOnce().mode, RobotMode::kReflex);
  EXPECT_EQ(robot::fci::Text(next.ReadOnce().last_motion_errors), kLost);
  next.Recover();
  next.Control(CommandKind::kPositions, Swing());
}

TEST(FciServer, OutlivesAClientThatDies) {
  const ServedPanda panda;
  {
    auto client = std::make_unique<FciClient>(panda.address());
    robot::fci::MoveRequest request{};
    const auto id = client->Send(robot::fci::Request::kMove, robot::fci::ToBytes(request));
    EXPECT_EQ(client->AwaitReply(id).front(), 1);
    for (int k = 0; k < 10; ++k) {
      const robot::fci::RobotState state = client->AwaitState();
      robot::fci::RobotCommand command{};
      command.message_id = state.message_id;
      command.q_c = state.q_d;
      client->Answer(command);
    }
  }
  RawFciDriver driver(panda.address());
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kReflex);
  driver.Recover();
  driver.Control(CommandKind::kPositions, Swing());
}

TEST(FciServer, LosesAClientThatThinksTooLong) {
  sim::fci::ServerOptions options;
  options.grace_s = 0.05;
  const ServedPanda panda("", options);
  RawFciDriver driver(panda.address());
  int calls = 0;
  const FciError error =
      FailureOf(driver, CommandKind::kPositions, [&](const RobotSnapshot& state, int) {
        if (++calls == 100) std::this_thread::sleep_for(std::chrono::milliseconds(500));
        return Command{state.q_d, calls == kFarTooLong};
      });
  EXPECT_EQ(robot::fci::Text(error.errors()), kLost);
}

TEST(FciServer, DoesNotWaitForAFirstCommandForEver) {
  sim::fci::ServerOptions options;
  options.grace_s = 0.05;
  const ServedPanda panda("", options);
  FciClient client(panda.address());
  const auto id =
      client.Send(robot::fci::Request::kMove, robot::fci::ToBytes(robot::fci::MoveRequest{}));
  EXPECT_EQ(client.AwaitReply(id).front(),
            static_cast<std::uint8_t>(robot::fci::MoveStatus::kMotionStarted));
  EXPECT_EQ(client.AwaitReply(id).front(),
            static_cast<std::uint8_t>(robot::fci::MoveStatus::kReflexAborted));
}

TEST(FciServer, StopsFromInsideAndFromAnotherThread) {
  const ServedPanda panda;
  RawFciDriver driver(panda.address());
  int calls = 0;
  EXPECT_EQ(FailureOf(driver, CommandKind::kPositions,
                      [&](const RobotSnapshot& state, int) {
                        if (++calls == 300) driver.Stop();
                        return Command{state.q_d, calls == kFarTooLong};
                      })
                .kind(),
            Kind::kPreempted);
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kIdle);

  std::atomic<bool> runs = false;
  std::thread stopper([&] {
    while (!runs) std::this_thread::yield();
    driver.Stop();
  });
  EXPECT_EQ(FailureOf(driver, CommandKind::kPositions,
                      [&](const RobotSnapshot& state, int) {
                        runs = true;
                        return Command{state.q_d, ++calls == kFarTooLong};
                      })
                .kind(),
            Kind::kPreempted);
  stopper.join();
  driver.Stop();  // of nothing
  driver.Control(CommandKind::kPositions, Swing());
}

TEST(FciServer, StopsWhenTheCallbackFails) {
  const ServedPanda panda;
  RawFciDriver driver(panda.address());
  const auto motion = [&](double value) {
    return [value, calls = 0](const RobotSnapshot& state, int) mutable {
      Command command{state.q_d};
      if (++calls == 100) {
        if (value == 0) throw std::logic_error("of the callback");
        command.values[2] = value;
      }
      return command;
    };
  };
  EXPECT_THROW(driver.Control(CommandKind::kPositions, motion(0)), std::logic_error);
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kIdle);
  EXPECT_EQ(FailureOf(driver, CommandKind::kPositions, motion(std::nan(""))).kind(),
            Kind::kBadCommand);
  EXPECT_EQ(driver.ReadOnce().mode, RobotMode::kIdle);
  driver.Control(CommandKind::kPositions, Swing());
}

// A client without scruples: libfranka and ours send no such thing.
TEST(FciServer, EndsAMotionOfWhatIsNoNumber) {
  const ServedPanda panda;
  FciClient client(panda.address());
  robot::fci::MoveRequest request{};
  const auto id = client.Send(robot::fci::Request::kMove, robot::fci::ToBytes(request));
  client.AwaitReply(id);
  client.AwaitState();
  robot::fci::RobotCommand command{};
  command.message_id = client.AwaitState().message_id;
  command.q_c.fill(std::nan(""));
  client.Answer(command);
  EXPECT_EQ(client.AwaitReply(id).front(),
            static_cast<std::uint8_t>(robot::fci::MoveStatus::kInputErrorAborted));
}

// Libfranka sees the mode change, then waits for the reply: so the state goes first, and has come
// when the reply comes. Without FciClient, which would wait for it.
TEST(FciServer, ShowsTheEndOfAMotionBeforeItTellsIt) {
  using namespace robot::fci;
  const ServedPanda panda;
  auto link = CommandLink::Connect(panda.address(), kCommandPort, std::chrono::seconds(1));
  DatagramPort states("0.0.0.0");
  RobotState state{};
  const auto look = [&] {
    bool is_new = false;
    while (const auto bytes = states.Receive(kRobotStateSize)) {
      const RobotState next = DecodeRobotState(*bytes);
      EXPECT_GT(next.message_id, state.message_id) << "libfranka takes no state twice";
      state = next;
      is_new = true;
    }
    return is_new;
  };
  // Finishes what motion there is, until something is replied.
  const auto reply = [&] {
    std::optional<Message> message;
    while (!(message = link.Receive())) {
      if (!look() || state.robot_mode != RobotMode::kMove) continue;
      RobotCommand command{};
      command.message_id = state.message_id;
      command.q_c = state.q_d;
      command.motion_generation_finished = 1;
      states.Send(Encode(command));
    }
    return message->payload.front();
  };
  link.Send({Request::kConnect, 0, ToBytes(ConnectRequest{kVersion, states.port()})});
  ASSERT_EQ(reply(), status::kSuccess);
  for (std::uint32_t id = 1; id <= 100; ++id) {
    link.Send({Request::kMove, id, ToBytes(MoveRequest{})});
    ASSERT_EQ(reply(), static_cast<std::uint8_t>(MoveStatus::kMotionStarted));
    ASSERT_EQ(reply(), status::kSuccess);
    look();
    ASSERT_EQ(state.robot_mode, RobotMode::kIdle) << id;
  }
}

TEST(FciServer, TakesNoAnswerToAnOlderState) {
  sim::fci::ServerOptions options;
  options.grace_s = 0.02;
  const ServedPanda panda("", options);
  FciClient client(panda.address());
  const auto id =
      client.Send(robot::fci::Request::kMove, robot::fci::ToBytes(robot::fci::MoveRequest{}));
  client.AwaitReply(id);
  robot::fci::RobotState state = client.AwaitState();
  int answered = 0;
  while (state.robot_mode != RobotMode::kReflex) {
    robot::fci::RobotCommand command{};
    command.message_id = state.message_id - (answered > 10 ? 1 : 0);
    command.q_c = state.q_d;
    client.Answer(command);
    if (state.robot_mode == RobotMode::kMove) ++answered;
    state = client.AwaitState();
  }
  EXPECT_EQ(
      state.reflex_reason[static_cast<std::size_t>(Error::kCommunicationConstraintsViolation)], 1);
  EXPECT_LT(answered, 50);
}

struct SettingCase {
  robot::fci::Request request;
  robot::fci::Bytes payload;
  std::uint8_t status;
};

TEST(FciServer, AnswersEveryRequest) {
  using namespace robot::fci;
  const ServedPanda panda;
  FciClient client(panda.address());
  const CollisionBehaviorRequest collision = sim::fci::DefaultCollisionBehavior();
  CollisionBehaviorRequest negative = collision;
  negative.upper_force_nominal[5] = -1;
  FrameRequest skewed{sim::fci::HandFrame()};
  skewed.pose[0] += 0.1;
  const SettingCase cases[] = {
      {Request::kSetCollisionBehavior, ToBytes(collision), 0},
      {Request::kSetCollisionBehavior, ToBytes(negative), 2},
      {Request::kSetJointImpedance, ToBytes(JointImpedanceRequest{{0, 1, 2, 3, 4, 5, 14250}}), 0},
      {Request::kSetJointImpedance, ToBytes(JointImpedanceRequest{{14251}}), 2},
      {Request::kSetJointImpedance, ToBytes(JointImpedanceRequest{{std::nan("")}}), 2},
      {Request::kSetCartesianImpedance, ToBytes(CartesianImpedanceRequest{}), 0},
      {Request::kSetGuidingMode, ToBytes(GuidingModeRequest{}), 0},
      {Request::kSetEEToK, ToBytes(FrameRequest{sim::fci::HandFrame()}), 0},
      {Request::kSetNEToEE, ToBytes(skewed), 2},
      {Request::kSetLoad, ToBytes(LoadRequest{0.5, {}, {}}), 0},
      {Request::kSetLoad, ToBytes(LoadRequest{-0.5, {}, {}}), 2},
      {Request::kSetFilters, ToBytes(FiltersRequest{}), 0},
      {Request::kGetCartesianLimit, ToBytes(CartesianLimitRequest{1}), 0},
      {Request::kAutomaticErrorRecovery, {}, 0},
      {Request::kStopMove, {}, 1},
      {Request::kLoadModelLibrary, ToBytes(ModelLibraryRequest{}), 1},
      {Request::kSetLoad, {}, 1},  // cut off
  };
  for (const SettingCase& test : cases) {
    EXPECT_EQ(client.Ask(test.request, test.payload), test.status) << Name(test.request);
  }
  const RobotState state = client.AwaitFreshState();
  EXPECT_EQ(state.m_load, 0.5);
  EXPECT_EQ(state.EE_T_K, sim::fci::HandFrame());
}

TEST(FciServer, TakesNoSettingsWhileAMotionRuns) {
  const ServedPanda panda;
  RawFciDriver driver(panda.address());
  bool refused = false;
  Swing swing;
  driver.Control(CommandKind::kPositions, [&](const RobotSnapshot& state, int elapsed_ms) {
    if (swing.time_ms() == 500) {
      try {
        driver.Configure(Thresholds(30));
      } catch (const FciError& error) {
        refused = error.kind() == Kind::kRefused;
      }
    }
    return swing(state, elapsed_ms);
  });
  EXPECT_TRUE(refused);
}

// What has happened until `end_ms` of two motions, an abort and a recovery, to the bit.
std::vector<double> Diary(const std::string& faults) {
  const ServedPanda panda(faults);
  RawFciDriver driver(panda.address());
  std::vector<double> diary;
  const auto note = [&](const RobotSnapshot& state) {
    for (const Joints* values : {&state.q, &state.dq, &state.q_d, &state.tau_J, &state.tau_ext}) {
      diary.insert(diary.end(), values->begin(), values->end());
    }
    diary.push_back(state.success_rate);
  };
  for (int motion = 0; motion < 2; ++motion) {
    Swing swing;
    try {
      driver.Control(CommandKind::kPositions, [&](const RobotSnapshot& state, int elapsed_ms) {
        note(state);
        return swing(state, elapsed_ms);
      });
    } catch (const FciError& error) {
      EXPECT_EQ(error.kind(), Kind::kReflex) << error.what();
      driver.Recover();
    }
    note(driver.ReadOnce());
  }
  return diary;
}

TEST(FciServer, GivesTheSameBitsEachTime) {
  const std::string faults =
      "{seed: 3, faults: [{kind: lose_some, at_s: 0, for_s: 1.5, rate: 0.01},"
      " {kind: error, at_s: 1.2, name: power_limit_violation}]}";
  const std::vector<double> first = Diary(faults);
  EXPECT_GT(first.size(), 36u * 2000);
  EXPECT_EQ(Diary(faults), first);
}

// With something in the way: the contact is felt, and ends the motion.
TEST(FciServer, FeelsWhatItRunsInto) {
  scenarios::Scenario scenario = sim::fci::PandaAlone();
  // Beside the hand (0.307, 0, 0.487), in the way of joint 1.
  scenario.static_obstacles.push_back(
      {"post", Pose(Eigen::Quaterniond::Identity(), {0.3, 0.25, 0.5}), Box{{0.2, 0.1, 1.0}}});
  const ServedPanda panda("", {}, scenario);
  RawFciDriver driver(panda.address());
  int time_ms = 0;
  const FciError error =
      FailureOf(driver, CommandKind::kVelocities, [&](const RobotSnapshot&, int elapsed_ms) {
        time_ms += elapsed_ms;
        Command command;
        command.values[0] = std::min(0.3, 0.001 * time_ms);
        command.finished = time_ms > 4000;
        return command;
      });
  EXPECT_EQ(error.kind(), Kind::kReflex);
  EXPECT_TRUE(robot::fci::Holds(error.errors(), Error::kCartesianReflex) ||
              robot::fci::Holds(error.errors(), Error::kJointReflex));
  EXPECT_GT(time_ms, 800) << "before it can have arrived";
  EXPECT_LT(time_ms, 4000);

  // The post has pushed the arm away; after a recovery a motion can begin where that left it.
  const auto aside_rad = [&driver] {
    const RobotSnapshot state = driver.ReadOnce();
    double most_rad = 0;
    for (std::size_t j = 0; j < state.q.size(); ++j) {
      most_rad = std::max(most_rad, std::abs(state.q[j] - state.q_d[j]));
    }
    return most_rad;
  };
  EXPECT_GT(aside_rad(), 1e-6);
  driver.Recover();
  EXPECT_EQ(aside_rad(), 0);
}

// The wall's clock is no part of a test; that it runs at all is.
TEST(FciServer, RunsByTheWallClockToo) {
  sim::fci::ServerOptions options;
  options.clock = sim::fci::ServerClock::kWall;
  const ServedPanda panda("", options);
  RawFciDriver driver(panda.address());
  int calls = 0;
  try {
    driver.Control(CommandKind::kPositions, [&](const RobotSnapshot& state, int) {
      ++calls;
      return Command{state.q_d, calls == 50};
    });
  } catch (const FciError& error) {  // on a machine that is busy
    EXPECT_EQ(robot::fci::Text(error.errors()), kLost);
  }
  EXPECT_GT(calls, 0);
}

}  // namespace
}  // namespace sidestep::hardware::fci_server_test
