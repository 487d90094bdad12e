// A Panda at the end of a wire as a robot that follows plans, in lock-step with the simulated robot
// server: what it promises as a RobotInterface, and what it does when something goes wrong.
#include "sidestep/hardware/panda_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/hardware/raw_fci_driver.h"
#include "sidestep/hardware/slow_move.h"
#include "sidestep/robot/robot_error.h"
#include "tests/hardware/perfect_panda.h"
#include "tests/hardware/served_panda.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"

namespace sidestep::hardware {
namespace {

PandaOptions LockStep(control::SafetyProfile profile = control::SafetyProfile::kOff) {
  PandaOptions options;
  options.lockstep = true;
  options.safety.profile = profile;
  options.safety.floor_m = -1;
  return options;
}

std::unique_ptr<PandaRobot> Connect(const ServedPanda& served,
                                    const PandaOptions& options = LockStep()) {
  return std::make_unique<PandaRobot>(std::make_unique<RawFciDriver>(served.address()),
                                      served.robot(), options);
}

// A motion of the first and the fourth joint; in a second, it is well within the limits.
Trajectory Nod(const Eigen::VectorXd& q, double duration_s = 1) {
  Trajectory motion;
  constexpr int kStates = 11;
  motion.t_s = Eigen::VectorXd::LinSpaced(kStates, 0, 1);
  motion.q = q.replicate(1, kStates);
  motion.v = Eigen::MatrixXd::Zero(7, kStates);
  for (int k = 0; k < kStates; ++k) {
    const double s = motion.t_s(k);
    for (const int joint : {0, 3}) {
      motion.q(joint, k) += 0.2 * (s * s * s * (10 - 15 * s + 6 * s * s));
      motion.v(joint, k) = 0.2 * 30 * s * s * (1 - s) * (1 - s) / duration_s;
    }
  }
  motion.t_s *= duration_s;
  return motion;
}

TEST(PandaRobot, TellsWhereItIsBeforeItIsAdvancedAndMovesNothing) {
  const ServedPanda served;
  const auto panda = Connect(served);
  const Eigen::VectorXd home = served.robot().configurations().at("home");
  EXPECT_EQ(panda->Read().t, EpisodeTime(0));
  EXPECT_LT((panda->Read().q - home).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(panda->Status().mode, robot::RobotMode::kReady);
}

TEST(PandaRobot, FollowsAPlanAndLogsEveryTick) {
  const ServedPanda served;
  const auto panda = Connect(served);
  const Eigen::VectorXd home = panda->Read().q;
  const Trajectory nod = Nod(home);
  panda->AdvanceTo(EpisodeTime(0.1));
  EXPECT_EQ(panda->Read().t, EpisodeTime(0.1));
  panda->Submit(nod, EpisodeTime(0.2));
  panda->AdvanceTo(EpisodeTime(0.7));
  EXPECT_EQ(panda->Status().mode, robot::RobotMode::kMoving);
  panda->AdvanceTo(EpisodeTime(1.7));
  EXPECT_LT((panda->Read().q - nod.q.rightCols<1>()).cwiseAbs().maxCoeff(), 2e-3);
  const std::vector<ControlSample> log = panda->TakeControlLog();
  ASSERT_EQ(log.size(), 1700u);
  for (std::size_t i = 0; i < log.size(); ++i) {
    ASSERT_EQ(log[i].t.seconds(), static_cast<double>(i) / 1000);
    const Eigen::VectorXd q = Sample(nod, log[i].t - EpisodeTime(0.2)).q;
    ASSERT_LT((log[i].q_command - q).cwiseAbs().maxCoeff(), 1e-4) << i;
  }
  EXPECT_EQ(panda->lost_ticks(), 0u);
}

TEST(PandaRobot, BrakesWhenToldToHold) {
  const ServedPanda served;
  const auto panda = Connect(served);
  panda->Submit(Nod(panda->Read().q), EpisodeTime(0));
  panda->AdvanceTo(EpisodeTime(0.5));
  ASSERT_GT(panda->Read().v.norm(), 0.2);
  panda->Hold();
  panda->AdvanceTo(EpisodeTime(1));
  EXPECT_LT(panda->Read().v.norm(), 1e-2);
  EXPECT_EQ(panda->Status().mode, robot::RobotMode::kHolding);
}

TEST(PandaRobot, GivesTheSameBitsAgainInLockStep) {
  std::vector<ControlSample> logs[2];
  for (std::vector<ControlSample>& log : logs) {
    const ServedPanda served;
    const auto panda = Connect(served);
    panda->Submit(Nod(panda->Read().q), EpisodeTime(0.05));
    for (double t_s = 0; t_s < 1.5; t_s += 0.0373) {
      panda->AdvanceTo(EpisodeTime(t_s));
      for (ControlSample& sample : panda->TakeControlLog()) log.push_back(std::move(sample));
    }
  }
  ASSERT_EQ(logs[0].size(), logs[1].size());
  for (std::size_t i = 0; i < logs[0].size(); ++i) {
    ASSERT_EQ(logs[0][i].q, logs[1][i].q) << i;
    ASSERT_EQ(logs[0][i].q_command, logs[1][i].q_command) << i;
    ASSERT_EQ(logs[0][i].torque, logs[1][i].torque) << i;
  }
}

// What goes wrong at 0.5 s of the motion, and what becomes of it.
struct Trouble {
  const char* name;
  const char* faults;  ///< for the server
  const char* says;    ///< in the error; empty: there is none
};
std::ostream& operator<<(std::ostream& stream, const Trouble& trouble) {
  return stream << trouble.name;
}

class PandaRobotInTrouble : public testing::TestWithParam<Trouble> {};

TEST_P(PandaRobotInTrouble, SaysSoWithItsLastTicks) {
  const Trouble& trouble = GetParam();
  const ServedPanda served(trouble.faults);
  const auto panda = Connect(served);
  panda->Submit(Nod(panda->Read().q), EpisodeTime(0));
  try {
    panda->AdvanceTo(EpisodeTime(0.45));
    panda->TakeControlLog();
    panda->AdvanceTo(EpisodeTime(1.5));
    EXPECT_STREQ(trouble.says, "");
  } catch (const robot::RobotError& error) {
    EXPECT_NE(std::string(error.what()).find(trouble.says), std::string::npos) << error.what();
    EXPECT_STRNE(trouble.says, "");
    ASSERT_FALSE(error.last_ticks().empty());
    EXPECT_NEAR(error.last_ticks().back().t.seconds(), 0.5, 0.03);
    EXPECT_EQ(panda->Status().mode, robot::RobotMode::kFault);
  }
}

INSTANTIATE_TEST_SUITE_P(
    OnTheWire, PandaRobotInTrouble,
    testing::Values(
        Trouble{"ALongBurstOfLostPackets", "faults: [{kind: lose_commands, at_s: 0.5, count: 19}]",
                ""},
        Trouble{"PacketsLostHereAndThere",
                "faults: [{kind: lose_some, at_s: 0.2, for_s: 1, rate: 0.05}]", ""},
        Trouble{"AGapOfEightMilliseconds", "faults: [{kind: lose_states, at_s: 0.5, count: 8}]",
                ""},
        Trouble{"TooLongABurst", "faults: [{kind: lose_commands, at_s: 0.5, count: 20}]",
                "communication_constraints_violation; --clock lockstep is for a server"},
        Trouble{"AHandThatGuidesTheArm", "faults: [{kind: guiding, at_s: 0.5, for_s: 5}]",
                "the motion was aborted; its mode is now 'guiding'"},
        Trouble{"AFewLostPackets", "faults: [{kind: lose_commands, at_s: 0.5, count: 8}]", ""},
        Trouble{"AUserStop", "faults: [{kind: user_stop, at_s: 0.5, for_s: 0.5}]", "stop"},
        Trouble{"AReflex", "faults: [{kind: error, at_s: 0.5, name: cartesian_reflex}]",
                "cartesian_reflex"},
        Trouble{"ACutConnection", "faults: [{kind: cut_link, at_s: 0.5}]", "closed"}),
    [](const auto& test) { return std::string(test.param.name); });

// The robot's estimate of the force at its hand, as the arm's own acceleration disturbs it: 20 N at
// 1 m/s^2. No limit is broken, and nothing is touched.
TEST(PandaRobot, SaysSoWhenItsHandAcceleratesMoreThanTheRobotBears) {
  const char* const estimate = "force_estimate: {per_speed_n_s_m: 0, per_acceleration_kg: 20}";
  const auto run = [&](double duration_s, std::vector<ControlSample>* ticks) -> std::string {
    const ServedPanda served(estimate);
    const auto panda = Connect(served);
    panda->Submit(Nod(panda->Read().q, duration_s), EpisodeTime(0));
    try {
      panda->AdvanceTo(EpisodeTime(duration_s + 0.5));
      return "";
    } catch (const robot::RobotError& error) {
      *ticks = error.last_ticks();
      EXPECT_EQ(panda->Status().mode, robot::RobotMode::kFault);
      return error.what();
    }
  };
  std::vector<ControlSample> ticks;
  EXPECT_EQ(run(2, &ticks), "");
  EXPECT_THAT(run(0.4, &ticks), ::testing::HasSubstr("reflex: cartesian_reflex"));

  // What it was told then.
  const robot::RobotModel model =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  const auto hand_m = [&](std::size_t i) -> Eigen::Vector3d {
    return model.ComputeLinkPoses(ticks[i].q_command).back().translation();
  };
  double fastest_m_s2 = 0;
  for (std::size_t i = 2; i < ticks.size(); ++i) {
    const Eigen::Vector3d a_m_s2 = (hand_m(i) - 2 * hand_m(i - 1) + hand_m(i - 2)) / 1e-6;
    fastest_m_s2 = std::max(fastest_m_s2, a_m_s2.norm());
  }
  EXPECT_GT(fastest_m_s2, 1);
  EXPECT_LT(fastest_m_s2, model.tool_limits().a_max);
}

// Each of the robot's own reasons for a reflex, told by the wire.
TEST(PandaRobot, TellsEachOfTheRobotsErrorsAndGoesOnOnlyAfterARecovery) {
  using namespace robot::fci;
  for (int error = 0; error < kNumErrors; ++error) {
    SCOPED_TRACE(ErrorName(error));
    const ServedPanda served(
        "faults: [{kind: error, at_s: 0.1, name: " + std::string(ErrorName(error)) + "}]");
    {
      const auto panda = Connect(served);
      panda->Submit(Nod(panda->Read().q), EpisodeTime(0));
      try {
        panda->AdvanceTo(EpisodeTime(1));
        ADD_FAILURE() << "nothing happened";
      } catch (const robot::RobotError& failure) {
        EXPECT_EQ(
            std::string(failure.what())
                .rfind("the motion was aborted by a reflex: " + std::string(ErrorName(error)), 0),
            0u)
            << failure.what();
      }
      EXPECT_EQ(panda->Status().mode, robot::RobotMode::kFault);
      EXPECT_THROW(panda->AdvanceTo(EpisodeTime(1.1)), robot::RobotError) << "it goes on by itself";
    }
    EXPECT_THROW(Connect(served), FciError) << "another one goes on without a recovery";
    RawFciDriver driver(served.address());
    EXPECT_EQ(driver.ReadOnce().mode, robot::fci::RobotMode::kReflex);
    EXPECT_EQ(Text(driver.ReadOnce().last_motion_errors), ErrorName(error));
    driver.Recover();
    EXPECT_EQ(driver.ReadOnce().mode, robot::fci::RobotMode::kIdle);
  }
}

// After a recovery a robot knows nothing of the plan that it followed before.
TEST(PandaRobot, BeginsAnewAfterARecovery) {
  const ServedPanda served("faults: [{kind: error, at_s: 0.3, name: joint_reflex}]");
  {
    const auto panda = Connect(served);
    panda->Submit(Nod(panda->Read().q), EpisodeTime(0));
    EXPECT_THROW(panda->AdvanceTo(EpisodeTime(1)), robot::RobotError);
  }
  RawFciDriver(served.address()).Recover();
  const auto panda = Connect(served);
  const Eigen::VectorXd q = panda->Read().q;
  panda->AdvanceTo(EpisodeTime(0.5));
  EXPECT_LT((panda->Read().q - q).cwiseAbs().maxCoeff(), 1e-3);
  const std::vector<ControlSample> log = panda->TakeControlLog();
  ASSERT_FALSE(log.empty());
  EXPECT_LT((log.front().q_command - q).cwiseAbs().maxCoeff(), 1e-3) << "it begins elsewhere";
  EXPECT_EQ(panda->Status().mode, robot::RobotMode::kReady);
}

TEST(PandaRobot, IsStoppedAtOnceWhenItIsAskedTo) {
  const ServedPanda served;
  bool is_asked = false;
  PandaOptions options = LockStep();
  options.stops_at_once = [&] { return is_asked; };
  const auto panda = Connect(served, options);
  panda->Submit(Nod(panda->Read().q), EpisodeTime(0));
  panda->AdvanceTo(EpisodeTime(0.5));
  is_asked = true;
  EXPECT_THROW(panda->AdvanceTo(EpisodeTime(100)), robot::RobotError);
  EXPECT_LT(panda->Read().t, EpisodeTime(99));
  const std::vector<SafetyEvent> events = panda->TakeSafetyEvents();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].check, "operator_stop");
  EXPECT_EQ(events[0].reaction, "abort");
}

// The thread that answers, from the state to the command.
TEST(PandaRobot, AllocatesNothingAndLocksNothingToAnswer) {
  const robot::RobotModel model =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  auto driver = std::make_unique<PerfectPanda>(RestingPanda());
  int allocations = 0, locks = 0, answers = 0, allocated = 0, locked = 0;
  driver->before = [&] {
    allocated = CountAllocationsOfThread();
    locked = CountLocksOfThread();
  };
  driver->after = [&] {
    allocations += CountAllocationsOfThread() - allocated;
    locks += CountLocksOfThread() - locked;
    ++answers;
  };
  {
    PandaRobot panda(std::move(driver), model, LockStep(control::SafetyProfile::kObserve));
    panda.Submit(Nod(panda.Read().q), EpisodeTime(0.1));
    ObstacleReport report;
    report.obstacles.resize(5);
    panda.Watch(report);
    panda.AdvanceTo(EpisodeTime(1.5));
  }  // the thread has ended
  EXPECT_GE(answers, 1500);
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(locks, 0);
  // The counters count.
  allocated = CountAllocationsOfThread();
  locked = CountLocksOfThread();
  std::mutex mutex;
  const std::lock_guard guard(mutex);
  const auto number = std::make_unique<int>(3);
  EXPECT_GT(CountAllocationsOfThread(), allocated);
  EXPECT_EQ(CountLocksOfThread() - locked, AreLocksCounted() ? 1 : 0);
}

// A clock that says that each answer takes 20 us, but for one in the hundred that takes 2 ms.
std::chrono::steady_clock::time_point SlowClock() {
  static std::atomic<int> calls = 0;
  static std::atomic<long> now_us = 0;
  now_us += ++calls % 200 == 0 ? 2000 : 20;
  return std::chrono::steady_clock::time_point(std::chrono::microseconds(now_us.load()));
}

TEST(PandaRobot, TellsHowLongItsAnswersTookAndTheFirstThatWasSlow) {
  const robot::RobotModel model =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  PandaOptions options = LockStep();
  options.lockstep = false;
  options.now = &SlowClock;
  PandaRobot panda(std::make_unique<PerfectPanda>(RestingPanda(), /*in_real_time=*/true), model,
                   options);
  std::vector<double> answers_s;
  while (answers_s.size() < 250) {
    panda.AdvanceTo(EpisodeTime(panda.Read().t.seconds() + 0.01));
    for (const double seconds : panda.TakeAnswerTimes()) answers_s.push_back(seconds);
  }
  const auto slow = [](double seconds) { return seconds > 300e-6; };
  EXPECT_GE(std::count_if(answers_s.begin(), answers_s.end(), slow), 2);
  EXPECT_NEAR(*std::min_element(answers_s.begin(), answers_s.end()), 20e-6, 1e-9);
  EXPECT_NEAR(*std::max_element(answers_s.begin(), answers_s.end()), 2e-3, 1e-9);
  const std::vector<SafetyEvent> events = panda.TakeSafetyEvents();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].check, "slow_answer");
  EXPECT_EQ(events[0].reaction, "none");
  EXPECT_NEAR(events[0].value, 2e-3, 1e-9);
  EXPECT_EQ(events[0].limit, 300e-6);
}

// A real arm has settled when it has been told the same 250 times.
TEST(PandaRobot, EndsAMotionAtRestAndSettled) {
  const robot::RobotModel model =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  auto driver = std::make_unique<PerfectPanda>(RestingPanda());
  int alike = 0;
  bool has_finished = false;
  driver->look = [&, last = robot::fci::Joints{}](const Command& command) mutable {
    alike = command.values == last ? alike + 1 : 0;
    last = command.values;
    has_finished = command.finished;
  };
  {
    PandaRobot panda(std::move(driver), model, LockStep());
    panda.Submit(Nod(panda.Read().q), EpisodeTime(0));
    panda.AdvanceTo(EpisodeTime(0.5));
    ASSERT_EQ(alike, 0) << "it has to be in motion";
  }
  EXPECT_TRUE(has_finished);
  EXPECT_GE(alike, 250);
}

TEST(SlowMove, IsAtRestAtBothEndsAndNoFasterThanATenth) {
  const robot::RobotModel panda =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  const Eigen::VectorXd from = panda.configurations().at("right_ready");
  const Eigen::VectorXd to = panda.configurations().at("table_forward");
  const Trajectory way = SlowMove(panda, from, to);
  ASSERT_NO_THROW(CheckTrajectory(way));
  EXPECT_EQ(way.q.leftCols<1>(), from);
  EXPECT_LT((way.q.rightCols<1>() - to).norm(), 1e-12);
  EXPECT_TRUE(way.v.leftCols<1>().isZero(0));
  double most = 0;
  for (int ms = 0; 1e-3 * ms < way.t_s(way.num_states() - 1); ++ms) {
    const TrajectoryPoint point = Sample(way, HorizonOffset(1e-3 * ms));
    for (int j = 0; j < 7; ++j) {
      const double share = std::abs(point.v(j)) / panda.limits()[static_cast<std::size_t>(j)].v_max;
      most = std::max(most, share);
    }
  }
  EXPECT_LE(most, kSlowShare + 1e-3);
  EXPECT_GE(most, kSlowShare - 1e-3) << "it could be faster";
}

}  // namespace
}  // namespace sidestep::hardware
