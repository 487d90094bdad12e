// What every driver of a Panda promises, held against the simulated robot server. Libfranka's is
// tried where this build has it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "sidestep/hardware/libfranka_driver.h"
#include "sidestep/hardware/raw_fci_driver.h"
#include "sidestep/hardware/readiness.h"
#include "tests/hardware/served_panda.h"

namespace sidestep::hardware::every_driver_test {
namespace {

using robot::fci::RobotMode;
using Kind = FciError::Kind;
using ::testing::HasSubstr;

class EveryDriver : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "Libfranka" && !HasLibfranka()) GTEST_SKIP() << "built without libfranka 0.9";
  }

  // Neither limiter nor filter: what is sent is what is checked.
  std::unique_ptr<FciDriver> Connect(const ServedPanda& panda) const {
    if (GetParam() == "Libfranka") {
      return MakeLibfrankaDriver(panda.address(), {false, false, 1000});
    }
    return std::make_unique<RawFciDriver>(panda.address());
  }
};

// Holds still for so many calls; then the motion is finished, or what `last` says happens.
FciDriver::NextCommand Hold(int calls, std::function<void(Command&)> last = nullptr) {
  return [=, count = 0, start = robot::fci::Joints{}](const RobotSnapshot& state, int) mutable {
    if (count++ == 0) start = state.q_d;
    Command command{start};
    if (count < calls) return command;
    if (last) {
      last(command);
    } else {
      command.finished = true;
    }
    return command;
  };
}

std::optional<FciError> FailureOf(FciDriver& driver, const FciDriver::NextCommand& next) {
  try {
    driver.Control(CommandKind::kPositions, next);
  } catch (const FciError& error) {
    return error;
  }
  return std::nullopt;
}

TEST_P(EveryDriver, RunsMotionsOfEveryKind) {
  const ServedPanda panda;
  const auto driver = Connect(panda);
  EXPECT_EQ(driver->server_version(), 5);
  FciSettings settings;
  settings.stiffness.fill(1000);
  settings.collision = sim::fci::DefaultCollisionBehavior();
  driver->Configure(settings);
  EXPECT_EQ(driver->ReadOnce().mode, RobotMode::kIdle);
  for (const CommandKind kind :
       {CommandKind::kPositions, CommandKind::kVelocities, CommandKind::kTorques}) {
    int calls = 0;
    driver->Control(kind, [&](const RobotSnapshot& state, int elapsed_ms) {
      EXPECT_EQ(elapsed_ms, calls == 0 ? 0 : 1);
      EXPECT_EQ(state.mode, RobotMode::kMove);
      Command command;
      if (kind == CommandKind::kPositions) command.values = state.q_d;
      command.finished = ++calls == 500;
      return command;
    });
    EXPECT_EQ(calls, 500);
    EXPECT_EQ(driver->ReadOnce().mode, RobotMode::kIdle);
  }
}

TEST_P(EveryDriver, TellsWhyAMotionWasAbortedAndRecovers) {
  const ServedPanda panda;
  const auto driver = Connect(panda);
  const auto error = FailureOf(*driver, Hold(100, [](Command& c) { c.values[0] += 0.01; }));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), Kind::kReflex);
  EXPECT_EQ(robot::fci::Text(error->errors()),
            "joint_motion_generator_velocity_limits_violation, "
            "joint_motion_generator_velocity_discontinuity, "
            "joint_motion_generator_acceleration_discontinuity");
  ASSERT_EQ(error->log().size(), 50u);
  EXPECT_EQ(error->log().back().command.values[0], error->log().front().command.values[0] + 0.01);
  EXPECT_EQ(driver->ReadOnce().mode, RobotMode::kReflex);
  EXPECT_EQ(driver->ReadOnce().last_motion_errors, error->errors());
  EXPECT_EQ(FailureOf(*driver, Hold(10))->kind(), Kind::kRefused);
  driver->Recover();
  EXPECT_FALSE(FailureOf(*driver, Hold(10)));
}

TEST_P(EveryDriver, StopsOnRequest) {
  const ServedPanda panda;
  const auto driver = Connect(panda);
  std::atomic<bool> runs = false;
  std::thread stopper([&] {
    while (!runs) std::this_thread::yield();
    driver->Stop();
  });
  const auto error = FailureOf(*driver, [&, calls = 0](const RobotSnapshot& state, int) mutable {
    runs = true;
    return Command{state.q_d, ++calls == 200000};
  });
  stopper.join();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), Kind::kPreempted);
  driver->Stop();  // of nothing
  EXPECT_FALSE(FailureOf(*driver, Hold(10)));
}

TEST_P(EveryDriver, StopsWhereTheCallbackFails) {
  const ServedPanda panda;
  const auto driver = Connect(panda);
  EXPECT_THROW(
      driver->Control(CommandKind::kPositions,
                      Hold(100, [](Command&) { throw std::logic_error("of the client"); })),
      std::logic_error);
  EXPECT_EQ(driver->ReadOnce().mode, RobotMode::kIdle);
  const auto error = FailureOf(*driver, Hold(100, [](Command& c) { c.values[3] = std::nan(""); }));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), Kind::kBadCommand);
  EXPECT_EQ(driver->ReadOnce().mode, RobotMode::kIdle);
}

TEST_P(EveryDriver, TellsAUserStop) {
  const ServedPanda panda("faults: [{kind: user_stop, at_s: 0.1, for_s: 60}]");
  const auto driver = Connect(panda);
  const auto error = FailureOf(*driver, Hold(200000));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), Kind::kUserStop);
  EXPECT_EQ(driver->ReadOnce().mode, RobotMode::kUserStopped);
  EXPECT_EQ(FailureOf(*driver, Hold(10))->kind(), Kind::kRefused);
  EXPECT_THROW(driver->Recover(), FciError);
}

TEST_P(EveryDriver, TellsThatTheRobotIsReadyOrGuidedByHand) {
  const ServedPanda panda("faults: [{kind: guiding, at_s: 0.1, for_s: 60}]");
  const auto driver = Connect(panda);
  EXPECT_FALSE(WhyNotReady(driver->ReadOnce(), panda.robot()));
  const auto error = FailureOf(*driver, Hold(200000));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), Kind::kAborted) << error->what();
  EXPECT_EQ(driver->ReadOnce().mode, RobotMode::kGuiding);
  EXPECT_TRUE(WhyNotReady(driver->ReadOnce(), panda.robot()));
}

TEST_P(EveryDriver, TellsThatTheRobotIsGone) {
  const ServedPanda panda("faults: [{kind: cut_link, at_s: 0.1}]");
  const auto driver = Connect(panda);
  const auto error = FailureOf(*driver, Hold(200000));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), Kind::kNetwork);
  EXPECT_EQ(error->log().size(), 50u);
}

TEST_P(EveryDriver, RefusesAnotherVersionAndNobody) {
  {
    const ServedPanda panda("version: 4");
    try {
      Connect(panda);
      FAIL() << "was connected";
    } catch (const FciError& error) {
      EXPECT_EQ(error.kind(), Kind::kVersion);
      EXPECT_THAT(error.what(), HasSubstr("4"));
    }
  }
  try {
    GetParam() == "Libfranka" ? MakeLibfrankaDriver(OwnLoopback(), {})
                              : std::make_unique<RawFciDriver>(OwnLoopback());
    FAIL() << "was connected";
  } catch (const FciError& error) {
    EXPECT_EQ(error.kind(), Kind::kNetwork);
  }
}

INSTANTIATE_TEST_SUITE_P(Drivers, EveryDriver, testing::Values("Raw", "Libfranka"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace sidestep::hardware::every_driver_test
