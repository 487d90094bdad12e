#include "sidestep/control/tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

#include "sidestep/core/random.h"
#include "sidestep/core/trajectory.h"

namespace sidestep::control::tracker_test {
namespace {

using Eigen::VectorXd;

constexpr double kPeriod_s = 0.001;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TrajectoryPoint At(const VectorXd& q) {
  return {q, VectorXd::Zero(q.size()), VectorXd::Zero(q.size())};
}

TrackerLimits OneJoint(double q, double v, double a, double jerk) {
  const auto one = [](double value) { return VectorXd::Constant(1, value); };
  return {one(-q), one(q), one(v), one(a), one(jerk)};
}

struct Sent {
  VectorXd q, v, a, jerk;
};

// A tracker, and the motion that it has led to so far.
class Driven {
 public:
  explicit Driven(const TrackerLimits& limits, double period_s = kPeriod_s)
      : tracker_(limits), period_s_(period_s) {}

  void Start(const VectorXd& q) { state_ = RestAt(q); }
  void Start(const VectorXd& q, const VectorXd& v, const VectorXd& a) { state_ = {q, v, a}; }
  Sent Step(const TrajectoryPoint& target) {
    return Send(tracker_.Step(state_, {target.q, target.v, target.a}, period_s_));
  }
  Sent Brake() { return Send(tracker_.Brake(state_, period_s_)); }

 private:
  Sent Send(const JointPoint& next) {
    const VectorXd jerk = (next.a - state_.a) / period_s_;
    state_ = next;
    return {next.q, next.v, next.a, jerk};
  }

  JerkLimitedTracker tracker_;
  double period_s_;
  JointPoint state_;
};

// Holds a stream of commands to the limits the way a robot's controller does: by the positions
// sent alone, and their backward differences.
class LimitJudge {
 public:
  LimitJudge(const TrackerLimits& limits, const VectorXd& q_start)
      : limits_(limits), q_(q_start), v_(VectorXd::Zero(q_start.size())), a_(v_) {}

  void Judge(const Sent& command) {
    const VectorXd v = (command.q - q_) / kPeriod_s;
    const VectorXd a = (v - v_) / kPeriod_s;
    const VectorXd jerk = (a - a_) / kPeriod_s;
    // A position of some rad is rounded to 4e-16; each difference divides that by the tick.
    const double ulp = 2e-15;
    for (Eigen::Index j = 0; j < q_.size(); ++j) {
      ASSERT_GE(command.q(j), limits_.q_min(j));
      ASSERT_LE(command.q(j), limits_.q_max(j));
      ASSERT_LE(std::abs(v(j)), limits_.v_max(j) + ulp / kPeriod_s);
      ASSERT_LE(std::abs(a(j)), limits_.a_max(j) + 2 * ulp / std::pow(kPeriod_s, 2));
      ASSERT_LE(std::abs(jerk(j)), limits_.jerk_max(j) + 4 * ulp / std::pow(kPeriod_s, 3));
      ASSERT_NEAR(command.v(j), v(j), ulp / kPeriod_s);
      ASSERT_NEAR(command.a(j), a(j), 2 * ulp / std::pow(kPeriod_s, 2));
      ASSERT_NEAR(command.jerk(j), jerk(j), 4 * ulp / std::pow(kPeriod_s, 3));
      largest_jerk_share_ = std::max(largest_jerk_share_, std::abs(jerk(j)) / limits_.jerk_max(j));
      largest_speed_share_ = std::max(largest_speed_share_, std::abs(v(j)) / limits_.v_max(j));
      largest_reach_ = std::max(largest_reach_, (command.q(j) - limits_.q_min(j)) /
                                                    (limits_.q_max(j) - limits_.q_min(j)));
    }
    q_ = command.q;
    v_ = v;
    a_ = a;
  }
  // How hard the limits were tried, as shares of them.
  double largest_jerk_share() const { return largest_jerk_share_; }
  double largest_speed_share() const { return largest_speed_share_; }
  double largest_reach() const { return largest_reach_; }

 private:
  TrackerLimits limits_;
  VectorXd q_, v_, a_;
  double largest_jerk_share_ = 0, largest_speed_share_ = 0, largest_reach_ = 0;
};

struct LimitsCase {
  std::string name, robot;
  double v_scale, a_scale, jerk_scale;
};
std::ostream& operator<<(std::ostream& stream, const LimitsCase& c) { return stream << c.name; }

class TrackerUnderLimits : public ::testing::TestWithParam<LimitsCase> {
 protected:
  const robot::RobotModel robot_ =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", GetParam().robot, Pose());
  const TrackerLimits limits_ =
      TrackerLimits::Of(robot_, GetParam().v_scale, GetParam().a_scale, GetParam().jerk_scale);
  const VectorXd home_ = robot_.configurations().begin()->second;
  Driven tracker_{limits_};

  // A cubic trajectory through random states: some calm, some far beyond every limit.
  Trajectory RandomTrajectory(RandomStream& random) {
    const int n = robot_.num_joints(), K = 4;
    const auto unit = [&] { return random.Uniform(-1, 1); };
    const double wildness = std::exp2(3 * unit() - 1);
    Trajectory trajectory;
    trajectory.t_s = VectorXd::LinSpaced(K, 0, 0.1 * (K - 1) * std::exp2(2 * unit()));
    trajectory.q.resize(n, K);
    trajectory.v.resize(n, K);
    for (int k = 0; k < K; ++k) {
      for (int j = 0; j < n; ++j) {
        const double middle = (limits_.q_min(j) + limits_.q_max(j)) / 2;
        const double half = (limits_.q_max(j) - limits_.q_min(j)) / 2;
        trajectory.q(j, k) = middle + wildness * half * unit();
        trajectory.v(j, k) = wildness * limits_.v_max(j) * unit();
      }
    }
    return trajectory;
  }
};

TEST_P(TrackerUnderLimits, BreaksNoneWhateverItIsToldToFollow) {
  RandomStream random(1, "trajectories");
  LimitJudge judge(limits_, home_);
  tracker_.Start(home_);
  for (int tick = 0; tick < 20000;) {
    const Trajectory trajectory = RandomTrajectory(random);
    const int end = tick + 1 + static_cast<int>(random.Bits() % 1500);
    const bool brake = random.Bits() % 5 == 0;
    for (int k = 1; tick < end; ++tick, ++k) {
      const TrajectoryPoint target = Sample(trajectory, HorizonOffset(k * kPeriod_s));
      ASSERT_NO_FATAL_FAILURE(judge.Judge(brake ? tracker_.Brake() : tracker_.Step(target)));
    }
  }
  // From wherever that ends, to what lies beyond the range.
  const TrajectoryPoint beyond = At(limits_.q_max + VectorXd::Ones(home_.size()));
  for (int tick = 0; tick < 20000 && judge.largest_reach() < 0.9999; ++tick) {
    ASSERT_NO_FATAL_FAILURE(judge.Judge(tracker_.Step(beyond)));
  }
  if (std::isfinite(limits_.jerk_max(0))) {
    EXPECT_GT(judge.largest_jerk_share(), 0.999) << "the limits were not tried";
  }
  EXPECT_GT(judge.largest_speed_share(), 0.999);
  EXPECT_GT(judge.largest_reach(), 0.999);
}

TEST_P(TrackerUnderLimits, ArrivesAtAFixedTargetAndStays) {
  for (const auto& [name, q] : robot_.configurations()) {
    LimitJudge judge(limits_, home_);
    tracker_.Start(home_);
    Sent command;
    for (int tick = 0; tick < 20000; ++tick) {
      command = tracker_.Step(At(q));
      ASSERT_NO_FATAL_FAILURE(judge.Judge(command));
    }
    EXPECT_LE((command.q - q).cwiseAbs().maxCoeff(), 1e-9) << name;
    EXPECT_LE(command.v.cwiseAbs().maxCoeff(), 1e-9) << name;
  }
}

TEST_P(TrackerUnderLimits, StopsAtItsRangeWhenTheTargetLiesBeyond) {
  tracker_.Start(home_);
  LimitJudge judge(limits_, home_);
  Sent command;
  for (int tick = 0; tick < 20000; ++tick) {
    command = tracker_.Step(At(limits_.q_max + VectorXd::Ones(home_.size())));
    ASSERT_NO_FATAL_FAILURE(judge.Judge(command));
  }
  EXPECT_LE((limits_.q_max - command.q).maxCoeff(), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Limits, TrackerUnderLimits,
                         ::testing::Values(LimitsCase{"Panda", "panda", 1, 1, 0.5},
                                           LimitsCase{"PandaAtTheMakersLimits", "panda", 1, 1, 1},
                                           LimitsCase{"PandaGently", "panda", 0.5, 0.5, 0.1},
                                           LimitsCase{"PandaWithLittleJerk", "panda", 1, 1, 0.02},
                                           LimitsCase{"WamWithoutLimitOfAcceleration", "wam", 1, 1,
                                                      1}),
                         [](const auto& test) { return test.param.name; });

// How far the command is from a plan within the limits, whose acceleration bends and jumps a little
// at its support states.
TEST(JerkLimitedTracker, FollowsAPlanWithinTheLimitsToTenMicroradians) {
  const robot::RobotModel panda =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  const int K = 31, n = panda.num_joints();
  Trajectory plan;
  plan.t_s = VectorXd::LinSpaced(K, 0, 3);
  plan.q.resize(n, K);
  plan.v.resize(n, K);
  const VectorXd start = panda.configurations().at("right_ready");
  const VectorXd goal = panda.configurations().at("table_forward");
  for (int k = 0; k < K; ++k) {  // the minimum-jerk polynomial, seen through cubics
    const double s = plan.t_s(k) / 3;
    plan.q.col(k) = start + (goal - start) * (s * s * s * (10 - 15 * s + 6 * s * s));
    plan.v.col(k) = (goal - start) * (30 * s * s * (1 - s) * (1 - s)) / 3;
  }
  Driven tracker(TrackerLimits::Of(panda));
  tracker.Start(start);
  double worst_rad = 0;
  for (int tick = 1; tick <= 3000; ++tick) {
    const TrajectoryPoint target = Sample(plan, HorizonOffset(tick * kPeriod_s));
    worst_rad = std::max(worst_rad, (tracker.Step(target).q - target.q).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(worst_rad, 1e-5);
  EXPECT_GT(worst_rad, 1e-9) << "the plan was not worth following";
}

// A jump da of the target's acceleration leaves the error da t^2 / 2 exp(-w t), whose peak, at
// t = 2 / w, is 0.2707 da / w^2.
TEST(JerkLimitedTracker, AnswersAJumpOfAccelerationAsItsThreePolesSay) {
  const double da = 5, w = 100, period_s = 1e-4;  // fine enough to compare with continuous time
  Driven tracker(OneJoint(10, 2, 10, 1e4), period_s);
  tracker.Start(VectorXd::Zero(1));
  double peak_rad = 0, last_rad = 0;
  for (int tick = 1; tick <= 3000; ++tick) {
    const double t = tick * period_s;
    const auto one = [](double value) { return VectorXd::Constant(1, value); };
    const TrajectoryPoint target{one(da * t * t / 2), one(da * t), one(da)};
    last_rad = std::abs(target.q(0) - tracker.Step(target).q(0));
    peak_rad = std::max(peak_rad, last_rad);
  }
  EXPECT_NEAR(peak_rad, 0.2707 * da / (w * w), 0.05 * 0.2707 * da / (w * w));
  EXPECT_LE(last_rad, 1e-8);
}

// The quickest stop from speed v without acceleration takes 2 sqrt(v / J), or, if the limit A of
// the acceleration is reached, v / A + A / J.
TEST(JerkLimitedTracker, BrakesInTheLeastTimeThereIs) {
  for (const double v : {0.01, 0.1, 0.5, 1.0, 2.0}) {
    for (const double jerk : {50.0, 500.0, 5000.0}) {
      const double A = 7.5;
      Driven tracker(OneJoint(10, 2.1, A, jerk));
      tracker.Start(VectorXd::Zero(1), VectorXd::Constant(1, v), VectorXd::Zero(1));
      int ticks = 0;
      for (Sent command; ticks < 5000; ++ticks) {
        command = tracker.Brake();
        ASSERT_GE(command.v(0), -1e-12) << "it went back";
        if (command.v(0) < 1e-12) break;
      }
      const double least_s = v >= A * A / jerk ? v / A + A / jerk : 2 * std::sqrt(v / jerk);
      EXPECT_LE(ticks * kPeriod_s, least_s + 2 * kPeriod_s) << v << " " << jerk;
      EXPECT_GE(ticks * kPeriod_s, least_s - 2 * kPeriod_s) << v << " " << jerk;
    }
  }
}

TEST(JerkLimitedTracker, StaysExactlyWhereItRests) {
  const VectorXd q = VectorXd::Constant(1, 0.1234567);
  Driven tracker(OneJoint(2, 2, 10, 1000));
  tracker.Start(q);
  for (int tick = 0; tick < 1000; ++tick) {
    const Sent command = tick % 2 == 0 ? tracker.Brake() : tracker.Step(At(q));
    ASSERT_EQ(command.q(0), q(0));
    ASSERT_EQ(command.v(0), 0);
    ASSERT_EQ(command.a(0), 0);
    ASSERT_EQ(command.jerk(0), 0);
  }
}

TEST(JerkLimitedTracker, ComesToExactRestWhenBraked) {
  Driven tracker(OneJoint(2, 2, 10, 1000));
  tracker.Start(VectorXd::Zero(1), VectorXd::Constant(1, 0.7654321), VectorXd::Constant(1, 3.21));
  Sent command;
  for (int tick = 0; tick < 500; ++tick) command = tracker.Brake();
  EXPECT_EQ(command.v(0), 0);
  EXPECT_EQ(command.a(0), 0);
}

TEST(JerkLimitedTracker, GoesOnFromAMovingStateWithoutAJump) {
  const TrackerLimits limits = OneJoint(2, 2, 10, 1000);
  Driven first(limits), second(limits);
  first.Start(VectorXd::Zero(1));
  Sent command;
  for (int tick = 0; tick < 100; ++tick) command = first.Step(At(VectorXd::Ones(1)));
  ASSERT_GT(command.v(0), 0.1);
  second.Start(command.q, command.v, command.a);
  for (int tick = 0; tick < 100; ++tick) {
    EXPECT_EQ(first.Step(At(VectorXd::Ones(1))).q, second.Step(At(VectorXd::Ones(1))).q);
  }
}

TEST(JerkLimitedTracker, ComesBackFromBeyondItsRangeAndNeverGoesFurtherOut) {
  Driven tracker(OneJoint(1, 2, 10, 1000));
  tracker.Start(VectorXd::Constant(1, 1.2));
  double outermost = 0;
  for (int tick = 0; tick < 500; ++tick) {
    outermost = std::max(outermost, tracker.Step(At(VectorXd::Constant(1, 5))).q(0));
  }
  EXPECT_EQ(outermost, 1.2);
  Sent command;
  for (int tick = 0; tick < 2000; ++tick) command = tracker.Step(At(VectorXd::Constant(1, 0.5)));
  EXPECT_NEAR(command.q(0), 0.5, 1e-9);
}

TEST(JerkLimitedTracker, BrakesAtOnceWhenItIsStartedTooFastToStopInTime) {
  Driven tracker(OneJoint(1, 2, 10, 1000)), braking(OneJoint(1, 2, 10, 1000));
  for (Driven* t : {&tracker, &braking}) {
    t->Start(VectorXd::Constant(1, 0.99), VectorXd::Constant(1, 1.5), VectorXd::Zero(1));
  }
  for (int tick = 0; tick < 100; ++tick) {
    EXPECT_EQ(tracker.Step(At(VectorXd::Constant(1, 5))).q, braking.Brake().q) << tick;
  }
}

TEST(JerkLimitedTracker, RefusesNonsense) {
  const VectorXd one = VectorXd::Ones(1), two = VectorXd::Ones(2);
  const VectorXd many = VectorXd::Ones(kMaxJoints + 1);
  EXPECT_THROW(JerkLimitedTracker(OneJoint(1, 0, 1, 1)), std::invalid_argument);
  EXPECT_THROW(JerkLimitedTracker(OneJoint(1, 1, -1, 1)), std::invalid_argument);
  EXPECT_THROW(JerkLimitedTracker(OneJoint(0, 1, 1, 1)), std::invalid_argument);
  EXPECT_THROW(JerkLimitedTracker(OneJoint(1, kInfinity, 1, 1)), std::invalid_argument);
  EXPECT_THROW(JerkLimitedTracker({-one, two, one, one, one}), std::invalid_argument);
  EXPECT_THROW(JerkLimitedTracker({-many, many, many, many, many}), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::control::tracker_test
