#include "sidestep/control/supervisor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sidestep/control/follower.h"
#include "sidestep/core/random.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"

namespace sidestep::control {
namespace {

using Eigen::Vector3d;

constexpr double kTick_s = 0.001;

robot::RobotModel Panda(const std::string& model = "panda") {
  return robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", model,
                                 Pose::Translation({0, 0, 0.5}));
}

SafetySettings Lab() {
  SafetySettings settings;
  settings.profile = SafetyProfile::kLab;
  settings.torque_n_m = JointVector::Constant(7, 20);
  settings.floor_m = 0.4;  // the base stands at 0.5
  return settings;
}

ObstacleState Ball(const Vector3d& p_W, const Vector3d& v_W, EpisodeTime t) {
  ObstacleState ball;
  ball.t = t;
  ball.X_WO = Pose::Translation(p_W);
  ball.radius_m = 0.1;
  ball.v_W = v_W;
  return ball;
}

// A Panda that does at once what it is told, swings to and fro at the shoulder, and sees a ball
// that may move. What is wrong with it is up to the test.
class Scene {
 public:
  explicit Scene(const SafetySettings& settings = Lab())
      : follower_(panda_, TrackerLimits::Of(panda_), settings),
        capsules_(panda_),
        state_(RestAt(panda_.configurations().at("ready"))) {
    Swing();
  }

  // What is reported, every 10 ms, of the world at that time.
  std::function<ObstacleReport(EpisodeTime)> see = [](EpisodeTime t) {
    return ObstacleReport{t, {}};
  };
  // What is wrong with what is measured.
  std::function<void(Measured&)> disturb = [](Measured&) {};

  void RunTo(double t_s) {
    for (; ticks_ < std::lround(t_s / kTick_s); ++ticks_) {
      const EpisodeTime t(static_cast<double>(ticks_) * kTick_s);
      if (ticks_ % 10 == 0) follower_.Watch(see(t));
      Measured measured{t, state_.q, state_.v, state_};
      disturb(measured);
      const int allocations = CountAllocations().count, locks = CountLocksOfThread();
      state_ = follower_.Tick(measured, HorizonOffset(kTick_s)).motion;
      ASSERT_EQ(CountAllocations().count, allocations);
      ASSERT_EQ(CountLocksOfThread(), locks);
      if (!state_.v.isZero(0)) last_moved_s_ = t.seconds();
      follower_.DrainFindings([this](const Finding& event) { findings_.push_back(event); });
      follower_.DrainLog([](const TickRecord&) {});
    }
  }

  // Submits the direct motion from where it rests.
  void Reach(const Eigen::VectorXd& q, double duration_s) {
    Trajectory way;
    way.t_s = Eigen::Vector2d(0, duration_s);
    way.q.resize(7, 2);
    way.q << state_.q, q;
    way.v = Eigen::MatrixXd::Zero(7, 2);
    follower_.Submit(way, EpisodeTime(static_cast<double>(ticks_) * kTick_s));
  }

  // Submits a swing of 0.5 rad and back, for 20 s, from where it rests.
  void Swing() {
    const double period_s = 4;
    Trajectory swing;
    constexpr int kStates = 101;
    swing.t_s = Eigen::VectorXd::LinSpaced(kStates, 0, 20);
    swing.q = Eigen::VectorXd(state_.q).replicate(1, kStates);
    swing.v = Eigen::MatrixXd::Zero(7, kStates);
    for (int k = 0; k < kStates; ++k) {
      const double w = 2 * 3.14159265358979 / period_s;
      swing.q(0, k) += 0.5 * (1 - std::cos(w * swing.t_s(k)));
      swing.v(0, k) = 0.5 * w * std::sin(w * swing.t_s(k));
    }
    follower_.Submit(swing, EpisodeTime(static_cast<double>(ticks_) * kTick_s));
  }

  // Submits a plan that goes on from here, but gets faster as suddenly as it can for 0.2 s.
  void Surge() {
    constexpr int kStates = 101, kSurge = 10;
    constexpr double kStep_s = 0.02, kFaster = 7, kSlower = -2;  // rad/s^2
    Trajectory surge;
    surge.t_s = Eigen::VectorXd::LinSpaced(kStates, 0, (kStates - 1) * kStep_s);
    surge.q = Eigen::VectorXd(state_.q).replicate(1, kStates);
    surge.v = Eigen::VectorXd(state_.v).replicate(1, kStates);
    for (int k = 1; k < kStates; ++k) {
      const double v = surge.v(0, k - 1);
      surge.v(0, k) = std::max(0.0, v + kStep_s * (k <= kSurge ? kFaster : kSlower));
      surge.q(0, k) = surge.q(0, k - 1) + kStep_s * (v + surge.v(0, k)) / 2;
    }
    follower_.Submit(surge, EpisodeTime(static_cast<double>(ticks_) * kTick_s));
  }

  Follower& follower() { return follower_; }
  const JointPoint& state() const { return state_; }
  robot::RobotMode mode() const { return follower_.mode(); }
  bool is_at_rest() const { return state_.v.isZero(0) && state_.a.isZero(0); }
  double last_moved_s() const { return last_moved_s_; }
  const std::vector<Finding>& events() const { return findings_; }
  // The first one of a check with that reaction; null if there is none.
  const Finding* First(SafetyCheck check, Reaction reaction) const {
    const auto found = std::find_if(findings_.begin(), findings_.end(), [&](const Finding& event) {
      return event.check == check && event.reaction == reaction;
    });
    return found == findings_.end() ? nullptr : &*found;
  }
  // From the arm, as it is, to a ball.
  double DistanceTo(const ObstacleState& ball) const {
    ArmCapsules::All placed;
    capsules_.Place(state_.q, placed);
    double nearest = 1e9;
    for (int k = 0; k < capsules_.size(); ++k) {
      const auto& capsule = placed[static_cast<std::size_t>(k)];
      const Vector3d ab = capsule.b - capsule.a, ap = ball.X_WO.translation() - capsule.a;
      const double s = std::clamp(ap.dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (ap - s * ab).norm() - capsule.radius_m - ball.radius_m);
    }
    return nearest;
  }

 private:
  robot::RobotModel panda_ = Panda();
  Follower follower_;
  ArmCapsules capsules_;
  JointPoint state_;
  long ticks_ = 0;
  double last_moved_s_ = 0;
  std::vector<Finding> findings_;
};

TEST(Supervisor, LetsAMotionPassThatNothingIsWrongWith) {
  Scene scene;
  scene.see = [](EpisodeTime t) { return ObstacleReport{t, {Ball({-2, 2, 1}, {0.3, 0, 0}, t)}}; };
  scene.RunTo(3);
  EXPECT_THAT(scene.events(), testing::IsEmpty());
  EXPECT_EQ(scene.mode(), robot::RobotMode::kMoving);
  EXPECT_GT(scene.last_moved_s(), 2.99);
}

// What is done to a scene that goes well, at 1 s, and what has to come of it.
struct Fault {
  const char* name;
  SafetyCheck check;
  Reaction reaction;
  double found_by_s;  ///< after the fault, at the latest
  std::function<void(Scene&)> inject;
};
std::ostream& operator<<(std::ostream& stream, const Fault& fault) { return stream << fault.name; }

std::vector<Fault> Faults() {
  const auto measured = [](auto spoil) { return [spoil](Scene& scene) { scene.disturb = spoil; }; };
  const auto seen = [](auto see) { return [see](Scene& scene) { scene.see = see; }; };
  return {
      {"EveryScanLost", SafetyCheck::kPerceptionStale, Reaction::kHold, 0.32, seen([](EpisodeTime) {
         return ObstacleReport{EpisodeTime(1), {}};
       })},
      {"FramesOfTheFuture", SafetyCheck::kTimeStamps, Reaction::kHold, 0.02,
       seen([](EpisodeTime t) {
         return ObstacleReport{t + HorizonOffset(0.05), {}};
       })},
      {"AnObstacleLost", SafetyCheck::kObstacleLost, Reaction::kHold, 0.32, seen([](EpisodeTime t) {
         return ObstacleReport{t, {Ball({-2, 2, 1}, Vector3d::Zero(), EpisodeTime(1))}};
       })},
      {"AnObstacleFasterThanDeclared", SafetyCheck::kObstacleTooFast, Reaction::kBrake, 0.12,
       seen([](EpisodeTime t) {
         return ObstacleReport{t, {Ball({-3, 3, 1}, {0, -0.6, 0}, t)}};
       })},
      {"SomethingTooNear", SafetyCheck::kClearance, Reaction::kHold, 0.02, seen([](EpisodeTime t) {
         return ObstacleReport{t, {Ball({0.3, 0, 1.35}, Vector3d::Zero(), t)}};
       })},
      {"TheArmNotWhereItWasTold", SafetyCheck::kTracking, Reaction::kBrake, 0.002,
       measured([](Measured& m) { m.q(2) += 0.03; })},
      {"APositionThatIsNoNumber", SafetyCheck::kTracking, Reaction::kBrake, 0.002,
       measured([](Measured& m) { m.q(2) = std::nan(""); })},
      {"APush", SafetyCheck::kExternalTorque, Reaction::kBrake, 0.03,
       measured([](Measured& m) { m.tau_ext = JointVector::Constant(7, 11); })},
      {"PacketsLostOneAfterTheOther", SafetyCheck::kLink, Reaction::kHold, 0.002,
       measured([](Measured& m) { m.lost_in_a_row = 6; })},
      {"ManyPacketsLost", SafetyCheck::kLink, Reaction::kHold, 0.002,
       measured([](Measured& m) { m.success_rate = 0.85; })},
      {"ARobotThatSaysThatItIsNotFit", SafetyCheck::kRobotMode, Reaction::kBrake, 0.002,
       measured([](Measured& m) { m.is_fit = false; })},
      {"APlanThatBeginsElsewhere", SafetyCheck::kSplice, Reaction::kRefuse, 0.002,
       [](Scene& scene) {
         Trajectory elsewhere;
         elsewhere.t_s = Eigen::VectorXd::Zero(1);
         elsewhere.q = scene.state().q;
         elsewhere.q(3) += 0.01;
         elsewhere.v = Eigen::VectorXd::Zero(7);
         scene.follower().Submit(elsewhere, EpisodeTime(1));
       }},
      {"APlanThroughTheFloor", SafetyCheck::kWorkspace, Reaction::kBrake, 3,
       [](Scene& scene) {
         Trajectory down;
         down.t_s = Eigen::VectorXd::LinSpaced(2, 0, 4);
         down.q = Eigen::VectorXd(scene.state().q).replicate(1, 2);
         down.v = Eigen::MatrixXd::Zero(7, 2);
         down.v.col(0) = scene.state().v;
         down.q(1, 1) = 1.5;
         down.q(3, 1) = -1.8;
         scene.follower().Submit(down, EpisodeTime(1));
       }},
  };
}

class SupervisorFault : public testing::TestWithParam<Fault> {};

TEST_P(SupervisorFault, IsFoundAndTheRobotComesToRestAsSpecified) {
  const Fault& fault = GetParam();
  Scene scene;
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(1));
  ASSERT_THAT(scene.events(), testing::IsEmpty());
  ASSERT_GT(scene.state().v.norm(), 0.1) << "it was at rest anyway";
  fault.inject(scene);
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(5));
  const Finding* const found = scene.First(fault.check, fault.reaction);
  ASSERT_NE(found, nullptr);
  EXPECT_LE(found->t.seconds(), 1 + fault.found_by_s + 1e-9);
  EXPECT_TRUE(scene.is_at_rest());
  EXPECT_LE(scene.last_moved_s(), found->t.seconds() + 0.35);  // the longest stop
  EXPECT_EQ(scene.mode(), fault.reaction == Reaction::kBrake ? robot::RobotMode::kFault
                                                             : robot::RobotMode::kHolding);
}

// A hold ends by itself when its cause has been gone for a second and there is a plan from where
// the robot is; a brake does not, until somebody rearms it.
TEST_P(SupervisorFault, EndsByItselfOnlyIfItWasAHold) {
  const Fault& fault = GetParam();
  Scene scene;
  const auto see = scene.see;
  const auto disturb = scene.disturb;
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(1));
  fault.inject(scene);
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(5));
  scene.see = see;
  scene.disturb = disturb;
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(5.9));
  EXPECT_TRUE(scene.is_at_rest()) << "it goes on too soon";
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(6.5));
  EXPECT_TRUE(scene.is_at_rest()) << "it goes on by a plan that it has left";
  if (fault.check == SafetyCheck::kWorkspace) return;  // it still stands too low
  scene.Swing();
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(7.5));
  EXPECT_EQ(scene.is_at_rest(), fault.reaction == Reaction::kBrake);
  if (fault.reaction != Reaction::kBrake) return;
  scene.follower().Rearm();
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(7.6));
  scene.Swing();
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(8.5));
  EXPECT_FALSE(scene.is_at_rest());
}

TEST_P(SupervisorFault, IsOnlyWrittenDownWhenItObserves) {
  const Fault& fault = GetParam();
  SafetySettings settings = Lab();
  settings.profile = SafetyProfile::kObserve;
  Scene scene(settings);
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(1));
  fault.inject(scene);
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(4.5));
  EXPECT_NE(scene.First(fault.check, fault.reaction), nullptr);
  EXPECT_EQ(scene.mode(), robot::RobotMode::kMoving);
  EXPECT_EQ(scene.follower().lag().seconds(), 0) << "it has slowed down";
}

INSTANTIATE_TEST_SUITE_P(Injected, SupervisorFault, testing::ValuesIn(Faults()),
                         [](const auto& test) { return std::string(test.param.name); });

// Where the swing is, for the first joint, that far into it.
double Swung(double t_s) { return 0.5 * (1 - std::cos(2 * 3.14159265358979 / 4 * t_s)); }

TEST(Supervisor, SlowsWithoutAScanFor150MsAndGoesOnLateByWhatThatCost) {
  Scene scene;
  const double start = scene.state().q(0);
  double latest_s = 0;
  // Between 0.7 s and 0.95 s there is no scan.
  scene.see = [&](EpisodeTime t) {
    if (t.seconds() < 0.7 || t.seconds() >= 0.95) latest_s = t.seconds();
    return ObstacleReport{EpisodeTime(latest_s), {}};
  };
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(0.84));
  EXPECT_EQ(scene.follower().lag().seconds(), 0);
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(0.95));
  const Finding* const found = scene.First(SafetyCheck::kPerceptionStale, Reaction::kSlow);
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->t.seconds(), 0.69 + 0.15, 0.002);
  EXPECT_GT(scene.follower().lag().seconds(), 0.02);
  EXPECT_EQ(scene.mode(), robot::RobotMode::kMoving);
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(2.5));
  EXPECT_THAT(scene.events(), testing::SizeIs(1))
      << "it slows within the limits, and does not stop";
  // It goes on with the same plan, at full speed, late by what it has lost.
  const double lag_s = scene.follower().lag().seconds();
  EXPECT_LT(lag_s, 0.25);
  EXPECT_NEAR(scene.state().q(0) - start, Swung(2.499 - lag_s), 1e-4);
}

TEST(Supervisor, LeavesThirtyPercentOfTheSpeedToAStaleView) {
  SafetySettings settings = Lab();
  settings.stale_s = 10;
  Scene scene(settings);
  scene.see = [](EpisodeTime) { return ObstacleReport{EpisodeTime(0), {}}; };
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(1));
  const double lag_s = scene.follower().lag().seconds();
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(2));
  EXPECT_NEAR(scene.follower().lag().seconds() - lag_s, 0.7, 1e-9);
}

TEST(Supervisor, DoesNotWaitForWhatHasLeft) {
  Scene scene;
  scene.see = [](EpisodeTime t) {
    ObstacleState ball = Ball({-2, 2, 1}, Vector3d::Zero(), EpisodeTime(0));
    ball.has_left = true;
    return ObstacleReport{t, {ball}};
  };
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(1));
  EXPECT_THAT(scene.events(), testing::IsEmpty());
}

TEST(Supervisor, BelievesASpeedAsFarAsItIsKnown) {
  for (const double sigma_m_s : {0.02, 0.05}) {
    Scene scene;
    scene.see = [&](EpisodeTime t) {
      ObstacleState ball = Ball({-3, 3, 1}, {0, -0.6, 0}, t);
      ball.speed_sigma_m_s = sigma_m_s;
      return ObstacleReport{t, {ball}};
    };
    ASSERT_NO_FATAL_FAILURE(scene.RunTo(1));
    const Finding* const found = scene.First(SafetyCheck::kObstacleTooFast, Reaction::kBrake);
    ASSERT_EQ(found != nullptr, sigma_m_s < 0.03);
    EXPECT_NEAR(found == nullptr ? 0.54 : found->value, 0.54, 1e-9);
  }
}

// What it may do in the time that an arm needs to stop is bounded by its speed, too: 0.2 s after it
// was seen, it is no further than 0.1 m from there, whatever its acceleration.
TEST(Supervisor, ReckonsWithNothingFasterThanDeclared) {
  SafetySettings settings = Lab();
  settings.obstacle_acceleration_m_s2 = 1000;
  settings.stale_s = 10;
  for (const double after_s : {0.2, 0.6}) {
    Scene scene(settings);
    const ObstacleState ball = Ball({-0.6, 0, 1}, Vector3d::Zero(), EpisodeTime(0));
    const double left_m = scene.DistanceTo(ball) - settings.margin_m;
    ASSERT_GT(left_m, 0.15);
    ASSERT_LT(left_m, 0.35);
    scene.see = [&](EpisodeTime t) { return ObstacleReport{t, {ball}}; };
    ASSERT_NO_FATAL_FAILURE(scene.RunTo(after_s));
    EXPECT_EQ(scene.First(SafetyCheck::kStopPath, Reaction::kHold) != nullptr, after_s > 0.5);
  }
}

// From a speed that would need a longer way to rest the arm is kept away, whatever it is told.
TEST(Supervisor, KeepsEveryStopShort) {
  const double kLongest_s = 0.1, kFurthest_m = 0.02;
  for (const bool by_time : {true, false}) {
    SafetySettings settings = Lab();
    (by_time ? settings.stop_s : settings.stop_m) = by_time ? kLongest_s : kFurthest_m;
    Scene scene(settings);
    const robot::RobotModel covered = Panda("panda:covered");
    const JerkLimitedTracker tracker(LabLimits(covered, settings));
    double longest_s = 0, furthest_m = 0;
    for (int tick = 1; tick <= 4000; ++tick) {
      ASSERT_NO_FATAL_FAILURE(scene.RunTo(tick * kTick_s));
      Eigen::VectorXd q_end = scene.state().q;
      for (int j = 0; j < 7; ++j) {
        const JointMotion motion = {scene.state().q(j), scene.state().v(j), scene.state().a(j)};
        const JointStop stop(motion, tracker.bounds(j), kTick_s);
        longest_s = std::max(longest_s, stop.ticks() * kTick_s);
        q_end(j) = stop.q_end();
      }
      // The cover, not the capsules that are looked at: all of the solids is in it.
      const Eigen::Matrix3Xd way_m = covered.ComputeSphereCenters(q_end, false).p_WS -
                                     covered.ComputeSphereCenters(scene.state().q, false).p_WS;
      furthest_m = std::max(furthest_m, way_m.colwise().norm().maxCoeff());
    }
    EXPECT_LE(by_time ? longest_s : furthest_m, by_time ? kLongest_s : kFurthest_m);
    EXPECT_GT(by_time ? longest_s : furthest_m, 0.7 * (by_time ? kLongest_s : kFurthest_m));
    EXPECT_NE(scene.First(SafetyCheck::kLongStop, Reaction::kSlow), nullptr);
    EXPECT_EQ(scene.mode(), robot::RobotMode::kMoving);
  }
}

TEST(Supervisor, SlowsBeforeItHasToStop) {
  Scene scene;
  // In the way of the hand, and stays.
  scene.see = [](EpisodeTime t) {
    return ObstacleReport{t, {Ball({0.22, 0.5, 1.1}, Vector3d::Zero(), t)}};
  };
  ASSERT_NO_FATAL_FAILURE(scene.RunTo(2));
  const Finding* const slow = scene.First(SafetyCheck::kStopPath, Reaction::kSlow);
  ASSERT_NE(slow, nullptr);
  EXPECT_EQ(scene.First(SafetyCheck::kClearance, Reaction::kHold), nullptr);
  EXPECT_GT(scene.follower().lag().seconds(), 0.1);
}

// How fast the tool is at most until `t_s`, by where each command puts it.
double FastestTool_m_s(Scene& scene, double t_s) {
  const robot::RobotModel panda = Panda();
  Vector3d last_m = panda.ComputeToolPose(scene.state().q).translation();
  double fastest_m_s = 0;
  for (int tick = 1; tick <= std::lround(t_s / kTick_s); ++tick) {
    scene.RunTo(tick * kTick_s);
    const Vector3d next_m = panda.ComputeToolPose(scene.state().q).translation();
    fastest_m_s = std::max(fastest_m_s, (next_m - last_m).norm() / kTick_s);
    last_m = next_m;
  }
  return fastest_m_s;
}

TEST(Supervisor, KeepsTheToolBelowItsSpeedAndFollowsThePlanOn) {
  Scene as_planned;
  const double planned_m_s = FastestTool_m_s(as_planned, 4);
  for (const double share : {0.9, 0.5, 0.2}) {
    SafetySettings settings = Lab();
    settings.tool_speed_m_s = share * planned_m_s;
    Scene scene(settings);
    const double fastest_m_s = FastestTool_m_s(scene, 4);
    EXPECT_LE(fastest_m_s, settings.tool_speed_m_s) << share;
    EXPECT_GT(fastest_m_s, 0.9 * settings.tool_speed_m_s) << share << ": slower than it has to be";
    EXPECT_NE(scene.First(SafetyCheck::kToolSpeed, Reaction::kSlow), nullptr);
    EXPECT_EQ(scene.First(SafetyCheck::kToolSpeed, Reaction::kHold), nullptr);
    EXPECT_EQ(scene.mode(), robot::RobotMode::kMoving);
    EXPECT_GT(scene.follower().lag().seconds(), 0.01);
  }
}

// By how much the accelerations of all joints change until `t_s`, up and down.
double ShakingUntil(Scene& scene, double t_s) {
  Eigen::VectorXd last = scene.state().a;
  double sum_rad_s2 = 0;
  for (int tick = 1; tick <= std::lround(t_s / kTick_s); ++tick) {
    scene.RunTo(tick * kTick_s);
    sum_rad_s2 += (scene.state().a - last).cwiseAbs().sum();
    last = scene.state().a;
  }
  return sum_rad_s2;
}

// Who brakes for a tick and catches up again and again shakes.
TEST(Supervisor, DoesNotShakeTheArmWhereThePlanIsTooFastForTheTool) {
  for (const double duration_s : {3.0, 5.0}) {
    const auto shaking_at = [&](double tool_m_s) {
      SafetySettings settings = Lab();
      settings.tool_speed_m_s = tool_m_s;
      Scene scene(settings);
      scene.Reach(Panda().configurations().at("table_forward"), duration_s);
      return ShakingUntil(scene, 20);
    };
    const double planned = shaking_at(10);
    for (const double tool_m_s : {0.25, 0.1}) {
      EXPECT_LT(shaking_at(tool_m_s), 5 * planned) << duration_s << " s, " << tool_m_s << " m/s";
    }
  }
}

// However suddenly a plan gets faster, the stop that is left keeps to the speed, too.
TEST(Supervisor, KeepsTheToolBelowItsSpeedWhenAPlanSurges) {
  for (const double share : {1.05, 1.2, 1.5, 2.0}) {
    Scene before;
    const double before_m_s = FastestTool_m_s(before, 0.7);
    SafetySettings settings = Lab();
    settings.tool_speed_m_s = share * before_m_s;
    Scene scene(settings);
    FastestTool_m_s(scene, 0.7);
    scene.Surge();
    EXPECT_LE(FastestTool_m_s(scene, 2), settings.tool_speed_m_s) << share;
    EXPECT_EQ(scene.mode(), robot::RobotMode::kMoving) << share;
  }
}

TEST(Supervisor, WritesDownAToolThatWouldBeTooFastWhenItObserves) {
  SafetySettings settings = Lab();
  settings.profile = SafetyProfile::kObserve;
  settings.tool_speed_m_s = 0.1;
  Scene scene(settings);
  EXPECT_GT(FastestTool_m_s(scene, 2), 0.2);
  EXPECT_NE(scene.First(SafetyCheck::kToolSpeed, Reaction::kEase), nullptr);
  EXPECT_EQ(scene.follower().lag().seconds(), 0);
}

// Balls from all sides, at the arm, within what was declared: they change their velocity as hard as
// they may, at random. The arm may be touched at rest, never in motion.
TEST(Supervisor, IsAtRestBeforeAnythingWithinTheEnvelopeTouchesIt) {
  RandomStream random(1, "balls");
  int stops = 0;
  for (int episode = 0; episode < 60; ++episode) {
    Scene scene;
    const SafetySettings settings = Lab();
    const double angle = random.Uniform(0, 6.28);
    Vector3d p(1.3 * std::cos(angle), 1.3 * std::sin(angle), random.Uniform(0.6, 1.4));
    Vector3d v = (Vector3d(0.3, 0, 1.1) - p).normalized() * 0.4;
    Vector3d a = Vector3d::Zero();
    ObstacleState ball;
    for (int ms = 0; ms < 5000; ms += 10) {
      if (ms % 200 == 0) {
        a = (Vector3d(0.3, 0, 1.1) - p).normalized();  // by and large towards the arm
        for (double& part : a) part += random.Uniform(-1, 1);
        a *= settings.obstacle_acceleration_m_s2 / a.norm();
      }
      v += 0.01 * a;
      if (v.norm() > settings.obstacle_speed_m_s) v *= settings.obstacle_speed_m_s / v.norm();
      p += 0.01 * v;
      ball = Ball(p, v, EpisodeTime(0.001 * ms));
      scene.see = [&](EpisodeTime t) { return ObstacleReport{t, {ball}}; };
      ASSERT_NO_FATAL_FAILURE(scene.RunTo(0.001 * (ms + 10)));
      if (scene.DistanceTo(ball) <= 0) {
        ASSERT_TRUE(scene.is_at_rest()) << "episode " << episode << " at " << ms << " ms";
        break;
      }
    }
    if (scene.First(SafetyCheck::kStopPath, Reaction::kHold) != nullptr) ++stops;
  }
  EXPECT_GT(stops, 20) << "nothing came near enough to show anything";
}

TEST(Supervisor, NeedsCapsules) {
  const robot::RobotModel wam =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "wam", Pose());
  EXPECT_THROW(Follower(wam, TrackerLimits::Of(wam), Lab()), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::control
