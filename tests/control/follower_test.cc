#include "sidestep/control/follower.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/allocations.h"

namespace sidestep::control {
namespace {

using Eigen::VectorXd;

constexpr HorizonOffset kTick(0.001);

TrackerLimits TwoJoints() {
  const auto both = [](double value) { return VectorXd::Constant(2, value); };
  return {both(-3), both(3), both(2), both(10), both(1000)};
}

// From where it stands to `to`, and there it stays.
Trajectory Move(double from, double to, double seconds) {
  Trajectory motion;
  motion.t_s = VectorXd::LinSpaced(2, 0, seconds);
  motion.q.resize(2, 2);
  motion.q << from, to, from, to;
  motion.v = Eigen::MatrixXd::Zero(2, 2);
  return motion;
}

// A robot that does at once what it is told, or, where packets are lost, goes on at the
// acceleration that it has: what a Panda's controller does.
class IdealRobot {
 public:
  explicit IdealRobot(Follower& follower) : follower_(follower) {}

  Command Tick() {
    const EpisodeTime t(static_cast<double>(ticks_) / 1000);
    const Command command = follower_.Tick({t, state_.q, state_.v, state_}, kTick);
    state_ = command.motion;
    ++ticks_;
    return command;
  }
  Command TickTo(double t_s) {
    Command command;
    while (ticks_ < std::lround(1000 * t_s)) command = Tick();
    return command;
  }
  void LosePackets(int count) {
    for (; count > 0; --count, ++ticks_) {
      state_.v += 0.001 * state_.a;
      state_.q += 0.001 * state_.v;
    }
  }
  const JointPoint& state() const { return state_; }

 private:
  Follower& follower_;
  JointPoint state_ = RestAt(JointVector::Zero(2));
  int ticks_ = 0;
};

TEST(Follower, StaysAtRestBeforeItsFirstPlanBegins) {
  Follower follower(TwoJoints());
  IdealRobot robot(follower);
  follower.Submit(Move(0, 1, 1), EpisodeTime(0.1));
  EXPECT_EQ(robot.TickTo(0.1).motion.q, Eigen::Vector2d::Zero());
  EXPECT_GT(robot.TickTo(0.2).motion.q(0), 0);
}

TEST(Follower, EndsWhereItsPlanEnds) {
  Follower follower(TwoJoints());
  IdealRobot robot(follower);
  follower.Submit(Move(0, 1, 1.5), EpisodeTime(0));
  EXPECT_NEAR(robot.TickTo(2.5).motion.q(0), 1, 1e-9);
}

TEST(Follower, GoesOnWithOnePlanUntilAnotherBegins) {
  Follower follower(TwoJoints()), undisturbed(TwoJoints());
  IdealRobot robot(follower), other(undisturbed);
  for (Follower* f : {&follower, &undisturbed}) f->Submit(Move(0, 1, 1.5), EpisodeTime(0));
  follower.Submit(Move(0.5, 0, 1.5), EpisodeTime(0.7));
  EXPECT_EQ(robot.TickTo(0.7).motion.q, other.TickTo(0.7).motion.q);
  EXPECT_NE(robot.TickTo(0.8).motion.q, other.TickTo(0.8).motion.q);
  EXPECT_NEAR(robot.TickTo(3).motion.q(0), 0, 1e-9);
}

TEST(Follower, ForgetsAPlanThatWasToBeginAfterOneSubmittedLater) {
  Follower follower(TwoJoints());
  IdealRobot robot(follower);
  follower.Submit(Move(0, 1, 0.5), EpisodeTime(0.6));
  follower.Submit(Move(0, 0.5, 0.5), EpisodeTime(0.3));
  EXPECT_NEAR(robot.TickTo(3).motion.q(0), 0.5, 1e-9);
}

TEST(Follower, BrakesWhenToldToHoldAndFollowsWhatIsSubmittedAfterThat) {
  Follower follower(TwoJoints());
  IdealRobot robot(follower);
  follower.Submit(Move(0, 1, 1), EpisodeTime(0));
  follower.Submit(Move(0.7, -1, 1), EpisodeTime(0.6));
  robot.TickTo(0.5);
  ASSERT_GT(robot.state().v(0), 1);
  follower.Hold();
  robot.TickTo(1.5);
  EXPECT_EQ(robot.state().v(0), 0);
  EXPECT_EQ(robot.state().a(0), 0);
  follower.Submit(Move(robot.state().q(0), 0.25, 1), EpisodeTime(1.6));
  follower.Hold();
  follower.Submit(Move(robot.state().q(0), 0.5, 1), EpisodeTime(1.7));
  EXPECT_NEAR(robot.TickTo(4).motion.q(0), 0.5, 1e-9);
}

TEST(Follower, LogsEveryTickInOrder) {
  Follower follower(TwoJoints());
  IdealRobot robot(follower);
  follower.Submit(Move(0, 1, 1), EpisodeTime(0));
  std::vector<JointVector> commands;
  for (int i = 0; i < 200; ++i) commands.push_back(robot.Tick().motion.q);
  std::vector<TickRecord> log;
  follower.DrainLog([&](const TickRecord& tick) { log.push_back(tick); });
  ASSERT_THAT(log, testing::SizeIs(200));
  for (std::size_t i = 0; i < log.size(); ++i) {
    EXPECT_EQ(log[i].t.seconds(), static_cast<double>(i) / 1000);
    EXPECT_EQ(log[i].command.q, commands[i]);
    const JointVector before = i == 0 ? JointVector::Zero(2) : commands[i - 1];
    EXPECT_EQ(log[i].q, before);  // it has done what it was told
  }
  EXPECT_EQ(follower.lost_ticks(), 0);
}

TEST(Follower, CountsTheTicksThatItsLogHasNoRoomFor) {
  Follower follower(TwoJoints(), 10);
  IdealRobot robot(follower);
  for (int i = 0; i < 25; ++i) robot.Tick();
  int logged = 0;
  follower.DrainLog([&](const TickRecord& tick) {
    EXPECT_EQ(tick.t.seconds(), logged / 1000.0);  // the first ones are kept
    ++logged;
  });
  EXPECT_EQ(logged, 10);
  EXPECT_EQ(follower.lost_ticks(), 15);
}

TEST(Follower, AllocatesNothingInATick) {
  Follower follower(TwoJoints());
  IdealRobot robot(follower);
  for (int i = 0; i < 20; ++i) {
    follower.Submit(Move(robot.state().q(0), i % 2, 0.3), EpisodeTime(0.1 * i));
    follower.Submit(Move(robot.state().q(0), i % 2, 0.4), EpisodeTime(0.1 * i + 0.05));
    if (i % 7 == 3) follower.Hold();
    const int before = CountAllocations().count;
    robot.TickTo(0.1 * (i + 1));
    ASSERT_EQ(CountAllocations().count, before);
  }
}

// After lost packets the robot has gone on by itself; the next command is within the limits of
// where it is now, not of where it would have been.
TEST(Follower, MakesNoJumpAfterLostPackets) {
  Follower follower(TwoJoints());
  IdealRobot robot(follower);
  follower.Submit(Move(0, 1.5, 1.5), EpisodeTime(0));
  robot.TickTo(0.2);
  for (const int lost : {1, 3, 10, 19}) {
    robot.LosePackets(lost);
    for (int i = 0; i < 30; ++i) {
      const JointPoint before = robot.state();
      const JointPoint command = robot.Tick().motion;
      for (int j = 0; j < 2; ++j) {
        EXPECT_LE(std::abs(command.v(j)), 2 + 1e-9);
        EXPECT_LE(std::abs(command.a(j)), 10 + 1e-9);
        EXPECT_LE(std::abs(command.a(j) - before.a(j)), 1000 * 0.001 + 1e-9);
        EXPECT_NEAR(command.q(j), before.q(j) + 0.001 * command.v(j), 1e-15);
      }
    }
  }
  EXPECT_NEAR(robot.TickTo(3).motion.q(0), 1.5, 1e-9);
}

TEST(Follower, RefusesATrajectoryThatDoesNotFit) {
  Follower follower(TwoJoints());
  Trajectory motion = Move(0, 1, 1);
  motion.q(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(follower.Submit(motion, EpisodeTime(0)), std::invalid_argument);
  motion = Move(0, 1, 1);
  motion.q.conservativeResize(1, 2);
  motion.v.conservativeResize(1, 2);
  EXPECT_THROW(follower.Submit(motion, EpisodeTime(0)), std::invalid_argument);
}

// Plans in one thread, ticks in another: each plan is seen whole, and the last one wins.
TEST(FollowerThreaded, IsHandedPlansByAnotherThread) {
  Follower follower(TwoJoints());
  std::atomic<bool> submitted = false;
  std::thread planning([&] {
    for (int i = 1; i <= 2000; ++i) {
      const double q = i / 2000.0;
      follower.Submit(Move(q, q, 0.1), EpisodeTime(0));
      if (i % 50 == 0) follower.Hold();
    }
    follower.Submit(Move(0.5, 0.5, 0.1), EpisodeTime(0));
    submitted = true;
  });
  IdealRobot robot(follower);
  int logged = 0, ticks = 0;
  for (int after = 0; after < 2000; ++ticks) {
    robot.Tick();
    if (submitted) ++after;
    follower.DrainLog([&](const TickRecord&) { ++logged; });
  }
  planning.join();
  EXPECT_EQ(logged, ticks);
  EXPECT_NEAR(robot.state().q(0), 0.5, 1e-6);
}

}  // namespace
}  // namespace sidestep::control
