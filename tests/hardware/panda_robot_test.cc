// A Panda at the end of a wire as a robot that follows plans, in lock-step with the simulated robot
// server: what it promises as a RobotInterface, and what it does when something goes wrong.
#include "sidestep/hardware/panda_robot.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/hardware/raw_fci_driver.h"
#include "sidestep/hardware/slow_move.h"
#include "sidestep/robot/robot_error.h"
#include "tests/hardware/served_panda.h"

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

// A second of motion of the first and the fourth joint, well within the limits.
Trajectory Nod(const Eigen::VectorXd& q) {
  Trajectory motion;
  constexpr int kStates = 11;
  motion.t_s = Eigen::VectorXd::LinSpaced(kStates, 0, 1);
  motion.q = q.replicate(1, kStates);
  motion.v = Eigen::MatrixXd::Zero(7, kStates);
  for (int k = 0; k < kStates; ++k) {
    const double s = motion.t_s(k);
    for (const int joint : {0, 3}) {
      motion.q(joint, k) += 0.2 * (s * s * s * (10 - 15 * s + 6 * s * s));
      motion.v(joint, k) = 0.2 * 30 * s * s * (1 - s) * (1 - s);
    }
  }
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
        Trouble{"AFewLostPackets", "faults: [{kind: lose_commands, at_s: 0.5, count: 8}]", ""},
        Trouble{"AUserStop", "faults: [{kind: user_stop, at_s: 0.5, for_s: 0.5}]", "stop"},
        Trouble{"AReflex", "faults: [{kind: error, at_s: 0.5, name: cartesian_reflex}]",
                "cartesian_reflex"},
        Trouble{"ACutConnection", "faults: [{kind: cut_link, at_s: 0.5}]", "closed"}),
    [](const auto& test) { return std::string(test.param.name); });

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
