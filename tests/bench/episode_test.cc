// The loop itself, with a robot that has no inertia: what it does when, and what it makes of it.
#include "sidestep/bench/episode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/record/journal.h"
#include "sidestep/record/recording_file.h"
#include "tests/bench/kinematic_world.h"
#include "tests/support/planar_arm.h"
#include "tests/support/random_points.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench {
namespace {

// The planar arm swings by 1.6 rad; a ball crosses its way, from below at the tip's half way.
scenarios::Scenario MakeScenario() {
  return scenarios::ParseScenario(R"(
description: A planar arm swings past a ball
robot: {model: planar_arm, base: {position_m: [0, 0, 0]}}
task: {start: [-0.8, 0], goal: [0.8, 0]}
horizon: {duration_s: 2.0, step_s: 0.1}
workspace: {first_center_m: [-0.3, -1.5, -0.2], cell_m: 0.05, cells: [36, 60, 9]}
floor_m: -2
static_boxes: []
moving_obstacles:
  - {name: ball, shape: {sphere: {radius_m: 0.12}},
     motion: {linear: {start_m: [0.9, -1.3, 0], direction: [0, 1, 0], speed_m_s: 1.3}}}
planner: {name: gpmp, epsilon_m: 0.1, sigma_obs: 0.05, n_int: 1}
knowledge: prediction
predictor: two_frame
replanning: {rate_hz: 10, latency_s: 0.1}
sensor: {name: occupancy, rate_hz: 30}
seed: 1
)",
                                  "loop.yaml");
}

constexpr double kLink_m = 0.5;  // of the planar arm, both

class Episode : public ::testing::Test {
 protected:
  EpisodeResult Run() { return RunEpisode(scenario_, arm_, world_.Factory()); }

  robot::RobotModel arm_ = MakePlanarArm();
  scenarios::Scenario scenario_ = MakeScenario();
  KinematicWorld world_;
};

TEST_F(Episode, ReachesTheGoalInTimeAndTouchesNothing) {
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kGoal);
  EXPECT_LE(result.recording.metrics.at("time_to_goal_s"), scenario_.horizon_s);
  EXPECT_GT(result.recording.metrics.at("min_clearance_m"), 0);
}

TEST_F(Episode, WithoutKnowingThatTheBallMovesItIsACollisionAndGoesOn) {
  scenario_.knowledge = "static";
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kCollision);
  EXPECT_GT(result.recording.control.back().t.seconds(),
            result.recording.metrics.at("first_contact_s") + 0.3);
}

TEST_F(Episode, EndsHalfASecondAfterTheGoal) {
  const EpisodeResult result = Run();
  EXPECT_NEAR(result.recording.control.back().t.seconds(),
              result.recording.metrics.at("time_to_goal_s") + 0.5, 0.0015);
}

TEST_F(Episode, ReachesTheGoalWhenTheArmHasStayedThereAsLongAsAsked) {
  scenario_.dwell_s = 0.3;
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kGoal);
  const double goal_s = result.recording.metrics.at("time_to_goal_s");
  const double dwell_s = result.recording.metrics.at("time_to_dwell_s");
  EXPECT_NEAR(dwell_s, goal_s + 0.3, 1e-9);
  EXPECT_NEAR(result.recording.control.back().t.seconds(), dwell_s + 0.5, 0.0015);
}

TEST_F(Episode, InWhichTheArmCannotStayLongEnoughIsATimeout) {
  scenario_.dwell_s = 2.0;  // the episode lasts 4 s, and the motion needs most of 2 s
  scenario_.moving_obstacles.clear();
  world_.moves = false;
  scenario_.q_start = scenario_.q_goal;
  EXPECT_EQ(Run().outcome, Outcome::kGoal);
  world_.moves = true;
  scenario_.q_start = MakeScenario().q_start;
  scenario_.horizon_s = 2.2;
  scenario_.dwell_s = 2.3;
  EXPECT_EQ(Run().outcome, Outcome::kTimeout);
}

TEST_F(Episode, RecordsTheLimitsThatWereAskedFor) {
  scenario_.velocity_scale = 0.6;
  scenario_.acceleration_limits = false;
  const record::MotionLimits limits = Run().recording.limits;
  EXPECT_EQ(limits.v_max, Eigen::Vector2d(0.6 * 2, 0.6 * 2));
  for (const Eigen::VectorXd* none : {&limits.a_max, &limits.jerk_max, &limits.torque_rate_max}) {
    EXPECT_EQ(none->size(), 2);
    EXPECT_TRUE((none->array() == std::numeric_limits<double>::infinity()).all());
  }
}

TEST_F(Episode, TellsWhenPlansTakeMoreThanWasAskedFor) {
  // There is just enough time for the direct way, and none to fold the arm past what stands in it.
  scenarios::MovingObstacle& ball = scenario_.moving_obstacles.front();
  ball.shape = Sphere{0.05};
  std::get<scenarios::LinearMotion>(ball.motion).start_m = {0.85, 0, 0};
  std::get<scenarios::LinearMotion>(ball.motion).speed_m_s = 0;
  scenario_.velocity_scale = 0.4;
  const record::Recording recording = Run().recording;
  const auto taken = std::find_if(recording.cycles.begin(), recording.cycles.end(),
                                  [](const CycleRecord& cycle) { return cycle.accepted; });
  ASSERT_NE(taken, recording.cycles.end());
  EXPECT_EQ(taken->status, "over_limits");
  EXPECT_GT(recording.metrics.at("planned_velocity_use"), 1.05);
  EXPECT_GT(recording.metrics.at("commanded_velocity_use"), 1.05);
}

TEST_F(Episode, TakesLongerThanItsHorizonWhereTheLimitsAskForIt) {
  scenario_.moving_obstacles.clear();
  scenario_.velocity_scale = 0.2;  // 2 rad in 2 s, where 0.4 rad/s are allowed
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kGoal);
  EXPECT_EQ(result.recording.cycles.at(0).status, "solved");
  EXPECT_LE(result.recording.metrics.at("planned_velocity_use"), 1.001);
  EXPECT_LE(result.recording.metrics.at("commanded_velocity_use"), 1.02);
  EXPECT_GT(result.recording.metrics.at("time_to_goal_s"), 2 * scenario_.horizon_s);
}

TEST_F(Episode, OfARobotThatDoesNotMoveEndsAtTwiceTheHorizon) {
  world_.moves = false;
  scenario_.moving_obstacles.clear();
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kTimeout);
  EXPECT_TRUE(std::isnan(result.recording.metrics.at("time_to_goal_s")));
  EXPECT_NEAR(result.recording.control.back().t.seconds(), 4.0, 0.0015);
}

TEST_F(Episode, OfARobotThatHasSlowedDownPlansOnFromWhereItIsOnItsPlan) {
  world_.slow_from_s = 0.55;
  world_.slow_until_s = 0.95;
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kGoal);
  const record::Recording& recording = result.recording;
  int compared = 0;
  for (const CycleRecord& cycle : recording.cycles) {
    if (!cycle.accepted || cycle.t.seconds() < 0.95 || cycle.t.seconds() > 1.9) continue;
    for (const ControlSample& tick : recording.control) {
      const HorizonOffset ahead = tick.t - cycle.t_effect;
      if (ahead.seconds() < 0 || ahead.seconds() > 0.05) continue;
      const TrajectoryPoint planned = Sample(cycle.plan, tick.t - cycle.plan_start);
      EXPECT_LT((tick.q - planned.q).cwiseAbs().maxCoeff(), 1e-6) << tick.t.seconds();
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
  EXPECT_NEAR(recording.metrics.at("time_to_goal_s"), scenario_.horizon_s + 0.2, 0.05);
}

TEST_F(Episode, OfARobotThatWasHeldGoesOnFromWhereItRests) {
  world_.held_from_s = 0.55;
  for (const double until_s : {0.85, 0.95, 1.05}) {
    world_.held_until_s = until_s;
    EpisodeOptions options;
    options.horizons = 3;
    const EpisodeResult result = RunEpisode(scenario_, arm_, world_.Factory(), options);
    const std::vector<ControlSample>& control = result.recording.control;
    for (std::size_t i = 1; i < control.size(); ++i) {
      const double jump_rad = (control[i].q - control[i - 1].q).cwiseAbs().maxCoeff();
      ASSERT_LT(jump_rad, 0.003) << control[i].t.seconds() << " s, held until " << until_s;
    }
    // A plan of a whole horizon, after a cycle that may have just begun.
    const double time_to_goal_s = result.recording.metrics.at("time_to_goal_s");
    EXPECT_LT(time_to_goal_s, until_s + 0.2 + scenario_.horizon_s) << "held until " << until_s;
  }
}

TEST_F(Episode, OfARobotThatSeesNothingGetsNoPlanAndSaysWhy) {
  world_.sees = false;
  scenario_.moving_obstacles.clear();
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kPlannerFailed);
  EXPECT_EQ(result.reason, "no scan has arrived");
  EXPECT_EQ(result.recording.header.at("reason"), result.reason);
  EXPECT_TRUE(result.recording.cycles.empty());
  EXPECT_TRUE(result.times.at("cycle").empty());
  EXPECT_TRUE(world_.submissions.empty());
}

TEST_F(Episode, GivesFieldsThatOutliveTheirWorldAndSayTheSameAfterwards) {
  RandomStream random(1, "points");
  const Eigen::Matrix3Xd p_WQ = UniformPoints(random, 200, 1);
  for (const sdf::Knowledge knowledge : sdf::kAllKnowledge) {
    std::vector<std::shared_ptr<const sdf::DistanceField>> fields;
    std::vector<Eigen::VectorXd> said_m;
    {
      scenarios::Scenario scenario = scenario_;
      scenario.knowledge = ToString(knowledge);
      KinematicWorld world;
      sdf::DistanceSamples samples;
      EpisodeOptions options;
      options.observe_field = [&](EpisodeTime, std::shared_ptr<const sdf::DistanceField> field,
                                  const robot::WorldTruth*) {
        field->SampleMany(p_WQ, EpisodeTime(0.7), samples);
        said_m.push_back(samples.distance_m);
        fields.push_back(std::move(field));
      };
      RunEpisode(scenario, arm_, world.Factory(), options);
    }
    ASSERT_FALSE(fields.empty());
    sdf::DistanceSamples samples;
    for (std::size_t n = 0; n < fields.size(); ++n) {
      fields[n]->SampleMany(p_WQ, EpisodeTime(0.7), samples);
      EXPECT_EQ(samples.distance_m, said_m[n]) << ToString(knowledge);
    }
  }
}

TEST_F(Episode, UnderTheProfileLabPlansForWhereThingsCanStrayWhileTheRobotStops) {
  const auto field_under = [&](scenarios::SafetyProfile profile) {
    scenario_.safety.profile = profile;
    scenario_.safety.obstacle_acceleration_m_s2 = 2;
    std::shared_ptr<const sdf::DistanceField> third;
    EpisodeOptions options;
    options.observe_field = [&](EpisodeTime t, const auto& field, const robot::WorldTruth*) {
      if (std::abs(t.seconds() - 0.3) < 1e-6) third = field;
    };
    RunEpisode(scenario_, arm_, world_.Factory(), options);
    return third;
  };
  const auto off = field_under(scenarios::SafetyProfile::kOff);
  const auto observe = field_under(scenarios::SafetyProfile::kObserve);
  const auto lab = field_under(scenarios::SafetyProfile::kLab);
  const auto distance_m = [&](const sdf::DistanceField& field, double t_s) {
    const Eigen::Vector3d p_WO =
        PoseAt(scenario_.moving_obstacles.front(), EpisodeTime(t_s)).translation();
    return field.Sample(p_WO - Eigen::Vector3d(0.22, 0, 0), EpisodeTime(t_s)).distance_m;
  };
  EXPECT_NEAR(distance_m(*off, 0.8), 0.1, 0.05);  // by cells of 0.05 m
  for (const double t_s : {0.3, 0.4, 0.8}) {
    EXPECT_EQ(distance_m(*observe, t_s), distance_m(*off, t_s)) << t_s;
    const double stop_s = std::min(t_s - 0.3, 0.25);
    EXPECT_NEAR(distance_m(*off, t_s) - distance_m(*lab, t_s), stop_s * stop_s, 1e-9) << t_s;
  }
}

TEST_F(Episode, ToAGoalOnWhichSomethingStandsSaysThatEveryPlanCollides) {
  scenario_.moving_obstacles.clear();
  scenario_.static_obstacles = {
      {"on the goal", Pose::Translation({0.6, 0.6, 0}), Box{{0.3, 0.3, 0.2}}}};
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kPlannerFailed);
  EXPECT_EQ(result.reason, "none of " + std::to_string(result.recording.cycles.size()) +
                               " plans was accepted; the last one: in_collision, "
                               "the goal is blocked when the horizon ends");
}

TEST_F(Episode, WithoutATruthIsUnjudgedAndStillSaysWhenTheGoalWasReached) {
  const EpisodeResult judged = Run();
  world_.judges = false;
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kUnjudged);
  EXPECT_EQ(result.recording.header.at("outcome"), "unjudged");
  EXPECT_TRUE(result.recording.truth.empty());
  EXPECT_TRUE(std::isnan(result.recording.metrics.at("min_clearance_m")));
  EXPECT_EQ(result.recording.metrics.at("time_to_goal_s"),
            judged.recording.metrics.at("time_to_goal_s"));
}

TEST_F(Episode, HoldsTheRobotWhenItEnds) {
  Run();
  EXPECT_TRUE(world_.holds);
}

TEST_F(Episode, GoesOnWithWhatItKnowsWhenAnOverdueSensorHasNothingMoreToGive) {
  world_.falls_silent_at_s = 0.5;
  scenario_.moving_obstacles.clear();
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kGoal);
  EXPECT_NEAR(result.recording.observations.back().t.seconds(), 0.5, 1.0 / 30);
  // Once a millisecond, until the end.
  const double silent_s = result.recording.control.back().t.seconds() - 0.5;
  EXPECT_NEAR(world_.empty_reads, 1000 * silent_s, 5);
}

// Two sensors that share what one sees: every other scan comes from the late one, so much later.
class SharedSensor {
 public:
  static constexpr HorizonOffset kLate{0.05};
  explicit SharedSensor(robot::Sensor& all) : prompt_(*this), late_(*this), all_(all) {}

  robot::Sensor* prompt() { return &prompt_; }
  robot::Sensor* late() { return &late_; }

 private:
  class Prompt final : public robot::Sensor {
   public:
    explicit Prompt(SharedSensor& shared) : shared_(shared) {}
    EpisodeTime NextDue() const override { return shared_.all_.NextDue(); }
    std::optional<Scan> Read(EpisodeTime now) override {
      std::optional<Scan> scan = shared_.all_.Read(now);
      if (!scan || shared_.num_read_++ % 2 == 0) return scan;
      shared_.waiting_.push_back(*std::move(scan));
      return std::nullopt;
    }

   private:
    SharedSensor& shared_;
  };

  class Late final : public robot::Sensor {
   public:
    explicit Late(SharedSensor& shared) : shared_(shared) {}
    EpisodeTime NextDue() const override {
      return shared_.waiting_.empty() ? EpisodeTime(std::numeric_limits<double>::infinity())
                                      : shared_.waiting_.front().t + kLate;
    }
    std::optional<Scan> Read(EpisodeTime now) override {
      if (now < NextDue()) return std::nullopt;
      Scan scan = std::move(shared_.waiting_.front());
      shared_.waiting_.pop_front();
      return scan;
    }

   private:
    SharedSensor& shared_;
  };

  Prompt prompt_;
  Late late_;
  robot::Sensor& all_;
  int num_read_ = 0;
  std::deque<Scan> waiting_;  // on their way
};

TEST_F(Episode, TakesInTheScansOfALateSensorInTheOrderOfCapture) {
  const EpisodeResult alone = Run();
  std::optional<SharedSensor> shared;
  const WorldFactory both = [&](const scenarios::Scenario& scenario,
                                const robot::RobotModel& robot) {
    EpisodeWorld world = world_.Factory()(scenario, robot);
    shared.emplace(*world.sensors.front().sensor);
    world.sensors = {{"prompt", shared->prompt()}, {"late", shared->late()}};
    return world;
  };
  const EpisodeResult result = RunEpisode(scenario_, arm_, both);
  EXPECT_EQ(result.outcome, Outcome::kGoal) << result.reason;
  // How late it is, is learned by the first.
  EXPECT_EQ(result.scans_left_out.at("late"), 1);
  EXPECT_EQ(result.scans_left_out.at("prompt"), 0);
  std::vector<record::ObservationRecord> expected = alone.recording.observations;
  expected.erase(expected.begin() + 1);
  const std::vector<record::ObservationRecord>& seen = result.recording.observations;
  ASSERT_GT(seen.size(), 30u);
  for (std::size_t i = 0; i < std::min(seen.size(), expected.size()); ++i) {
    EXPECT_EQ(seen[i].t, expected[i].t) << i;
    EXPECT_LE((seen[i].t_arrival - seen[i].t).seconds(), SharedSensor::kLate.seconds() + 1e-9) << i;
  }
}

TEST_F(Episode, ThatIsStoppedFromOutsideBrakesAndKeepsWhatHappened) {
  EpisodeOptions options;
  int cycles = 0;
  options.observe_field = [&](EpisodeTime, const auto&, const robot::WorldTruth*) { ++cycles; };
  options.why_stop = [&] { return cycles == 8 ? "a test" : ""; };
  const EpisodeResult result = RunEpisode(scenario_, arm_, world_.Factory(), options);
  EXPECT_EQ(result.outcome, Outcome::kAborted);
  EXPECT_EQ(result.reason, "it was stopped from outside: a test");
  ASSERT_EQ(result.recording.safety.size(), 1u);
  EXPECT_EQ(result.recording.safety[0].check, "operator_stop");
  EXPECT_EQ(result.recording.safety[0].reaction, "brake");
  EXPECT_TRUE(world_.holds);
  EXPECT_GE(result.recording.control.back().t.seconds(), 0.7);
  EXPECT_EQ(result.recording.cycles.size(), 8u);
}

TEST_F(Episode, WithoutLatencyGivesThePlanToTheRobotAtOnce) {
  scenario_.latency = scenarios::Latency::kNone;
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kGoal);
  ASSERT_FALSE(world_.submissions.empty());
  EXPECT_EQ(world_.submissions.front().when, result.recording.cycles.front().t);
  for (const CycleRecord& cycle : result.recording.cycles) EXPECT_EQ(cycle.t_effect, cycle.t);
}

TEST_F(Episode, WithMeasuredLatencyPlansTakeEffectWhenTheTimeTheyNeedHasPassed) {
  scenario_.latency = scenarios::Latency::kMeasured;
  const EpisodeResult result = Run();
  EXPECT_NE(result.outcome, Outcome::kAborted) << result.reason;
  const std::vector<CycleRecord>& cycles = result.recording.cycles;
  ASSERT_FALSE(cycles.empty());
  EXPECT_EQ(cycles[0].t_effect.seconds(), cycles[0].t.seconds() + scenario_.latency_s);
  int late = 0;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const double latency_s = (cycles[i].t_effect - cycles[i].t).seconds();
    EXPECT_GE(latency_s, 1e-3 - 1e-9);
    EXPECT_LE(latency_s, scenario_.latency_s + 1e-9);
    if (cycles[i].status == "late") {
      ++late;
      EXPECT_GT(result.times.at("cycle")[i], latency_s);
      EXPECT_FALSE(cycles[i].accepted);
    }
  }
  EXPECT_EQ(result.late_plans, late);
}

TEST_F(Episode, CountsTheCyclesThatNeededMoreThanTheyWereCharged) {
  scenario_.latency_s = 1e-7;
  const EpisodeResult result = Run();
  EXPECT_EQ(result.cycles_over_charge, static_cast<int>(result.recording.cycles.size()));
  scenario_.latency_s = 0.1;
  int longer = 0;
  const EpisodeResult charged = Run();
  for (const double cycle_s : charged.times.at("cycle")) longer += cycle_s > 0.1 ? 1 : 0;
  EXPECT_EQ(charged.cycles_over_charge, longer);
}

// In real time, so what it does depends on the machine; what holds on every one is asked.
TEST_F(Episode, OnAWallClockTakesAsLongAsItLastsAndDropsPlansThatComeLate) {
  scenario_.latency_s = 1e-6;  // no plan can be there by then
  EpisodeOptions options;
  options.clock = EpisodeClock::kWall;
  options.why_stop = [begin = std::chrono::steady_clock::now()] {
    const bool is_over = std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(600);
    return is_over ? "a test" : "";
  };
  const EpisodeResult result = RunEpisode(scenario_, arm_, world_.Factory(), options);
  EXPECT_GE(result.wall_s, result.recording.control.back().t.seconds() - 0.02);
  EXPECT_GT(result.late_plans, 0);
  EXPECT_TRUE(world_.submissions.empty());
  for (const CycleRecord& cycle : result.recording.cycles) {
    EXPECT_FALSE(cycle.status == "late" && cycle.accepted);
  }
}

TEST_F(Episode, OnAWallClockReachesTheGoal) {
  EpisodeOptions options;
  options.clock = EpisodeClock::kWall;
  const EpisodeResult result = RunEpisode(scenario_, arm_, world_.Factory(), options);
  EXPECT_NE(result.outcome, Outcome::kAborted) << result.reason;
  EXPECT_GE(result.wall_s, result.recording.control.back().t.seconds() - 0.02);
  for (const KinematicWorld::Submission& submission : world_.submissions) {
    EXPECT_GE(submission.when, EpisodeTime(0));
  }
  // The last one may be left when the episode ends.
  const double accepted = result.recording.metrics.at("plans_accepted");
  EXPECT_LE(static_cast<double>(world_.submissions.size()), accepted);
  EXPECT_GE(static_cast<double>(world_.submissions.size()), accepted - 1);
}

struct Failure {
  const char* who;
  double at_s;
};
std::ostream& operator<<(std::ostream& stream, const Failure& f) {
  return stream << f.who << " at " << f.at_s << " s";
}

class EpisodeThatFails : public Episode, public ::testing::WithParamInterface<Failure> {
 protected:
  // The observer is shown each planning cycle; the others are the world's.
  EpisodeResult RunUntilItBreaks() {
    const auto [who, at_s] = GetParam();
    world_.breaks = who;
    world_.breaks_at_s = at_s;
    EpisodeOptions options;
    options.observe_field = [&](EpisodeTime t, const auto&, const robot::WorldTruth*) {
      if (world_.breaks == "observer" && t.seconds() >= world_.breaks_at_s) {
        throw std::runtime_error("the observer broke");
      }
    };
    return RunEpisode(scenario_, arm_, world_.Factory(), options);
  }
};

TEST_P(EpisodeThatFails, IsAbortedWithItsReasonAndTheRobotHeld) {
  const EpisodeResult result = RunUntilItBreaks();
  EXPECT_EQ(result.outcome, Outcome::kAborted);
  EXPECT_EQ(result.reason, std::string("the ") + GetParam().who + " broke");
  EXPECT_EQ(result.recording.header.at("outcome"), "aborted");
  EXPECT_EQ(result.recording.header.at("reason"), result.reason);
  EXPECT_TRUE(world_.holds);
  EXPECT_THROW(RequireWhole(result), std::runtime_error);
}

TEST_P(EpisodeThatFails, KeepsWhatHappenedUntilThen) {
  const EpisodeResult result = RunUntilItBreaks();
  const double at_s = GetParam().at_s;
  const record::Recording& recording = result.recording;
  if (at_s == 0) {
    EXPECT_LE(recording.control.size(), 1u);
  } else {
    EXPECT_NEAR(recording.control.back().t.seconds(), at_s, 0.1);
    EXPECT_NEAR(recording.truth.back().t.seconds(), at_s, 0.1);
  }
  EXPECT_EQ(recording.metrics.size(), Metrics().size());
  const TemporaryFolder folder;
  record::WriteRecording(recording, folder.path() / "trace.h5");
  EXPECT_EQ(record::ReadRecording(folder.path() / "trace.h5").control.size(),
            recording.control.size());
}

INSTANTIATE_TEST_SUITE_P(OnTheWay, EpisodeThatFails,
                         ::testing::Values(Failure{"robot", 0}, Failure{"robot", 0.7123},
                                           Failure{"sensor", 0}, Failure{"sensor", 0.7},
                                           Failure{"truth", 0.7}, Failure{"observer", 0.7}));

TEST_F(Episode, KeepsWhatTheSupervisorFoundWhenTheRobotFailed) {
  world_.breaks = "robot";
  world_.breaks_at_s = 0.7;
  const record::Recording recording = Run().recording;
  ASSERT_EQ(recording.safety.size(), 1u);
  EXPECT_EQ(recording.safety.front().check, "link");
}

TEST_F(Episode, RecordsWhereEachCommandPutsTheTool) {
  const record::Recording recording = Run().recording;
  ASSERT_EQ(recording.p_WTool.size(), recording.control.size());
  for (std::size_t i = 0; i < recording.control.size(); ++i) {
    const Eigen::VectorXd& q = recording.control[i].q_command;
    const Eigen::Vector3d elbow(kLink_m * std::cos(q(0)), kLink_m * std::sin(q(0)), 0);
    const Eigen::Vector3d hand(kLink_m * std::cos(q.sum()), kLink_m * std::sin(q.sum()), 0);
    ASSERT_LT((elbow + hand - recording.p_WTool[i]).norm(), 1e-12);
  }
}

TEST_F(Episode, IsRecordedAlikeWithAJournalThatHoldsAllOfIt) {
  const record::Recording without = Run().recording;
  const TemporaryFolder folder;
  const std::string path = folder.path() / "trace.journal";
  EpisodeResult with;
  {
    record::Journal journal(path, {{"identity.run", "abc"}}, {});
    EpisodeOptions options;
    options.journal = &journal;
    with = RunEpisode(scenario_, arm_, world_.Factory(), options);
  }
  EXPECT_EQ(record::ToHdf5(with.recording), record::ToHdf5(without));

  const EpisodeResult cut_off = CutOffEpisode(record::ReadJournal(path).recording);
  EXPECT_EQ(cut_off.outcome, Outcome::kAborted);
  record::Recording salvaged = cut_off.recording;
  EXPECT_EQ(salvaged.header.at("outcome"), "aborted");
  EXPECT_EQ(salvaged.header.at("identity.run"), "abc");
  salvaged.header = without.header;
  EXPECT_EQ(record::ToHdf5(salvaged), record::ToHdf5(without));
}

TEST_F(Episode, ThatFailsAfterAContactKeepsTheContact) {
  scenario_.knowledge = "static";
  const double contact_s = Run().recording.metrics.at("first_contact_s");
  world_.breaks = "robot";
  world_.breaks_at_s = contact_s + 0.02;
  const EpisodeResult result = Run();
  EXPECT_EQ(result.outcome, Outcome::kAborted);
  EXPECT_EQ(result.recording.metrics.at("first_contact_s"), contact_s);
}

TEST_F(Episode, WhoseWorldCannotBeMadeIsNone) {
  const WorldFactory none = [](const scenarios::Scenario&,
                               const robot::RobotModel&) -> EpisodeWorld {
    throw std::runtime_error("no world");
  };
  EXPECT_THROW(RunEpisode(scenario_, arm_, none), std::runtime_error);
}

struct Timing {
  double rate_hz, latency_s, period_s;
};
std::ostream& operator<<(std::ostream& stream, const Timing& timing) {
  return stream << timing.rate_hz << " Hz, " << timing.latency_s << " s";
}

class EpisodeTiming : public Episode, public ::testing::WithParamInterface<Timing> {};

TEST_P(EpisodeTiming, PlansAtTheRateOrAsSoonAsTheLatencyIsOver) {
  scenario_.replan_rate_hz = GetParam().rate_hz;
  scenario_.latency_s = GetParam().latency_s;
  const EpisodeResult result = Run();
  ASSERT_GT(result.recording.cycles.size(), 5u);
  for (std::size_t i = 0; i < result.recording.cycles.size(); ++i) {
    const CycleRecord& cycle = result.recording.cycles[i];
    EXPECT_NEAR(cycle.t.seconds(), static_cast<double>(i) * GetParam().period_s, 1e-9);
    EXPECT_NEAR((cycle.t_effect - cycle.t).seconds(), GetParam().latency_s, 1e-9);
  }
}

TEST_P(EpisodeTiming, TellsTheRobotOnlyWhenTheLatencyIsOver) {
  scenario_.replan_rate_hz = GetParam().rate_hz;
  scenario_.latency_s = GetParam().latency_s;
  const EpisodeResult result = Run();
  std::size_t told = 0;
  for (const CycleRecord& cycle : result.recording.cycles) {
    if (!cycle.accepted || told == world_.submissions.size()) continue;
    EXPECT_NEAR(world_.submissions[told].when.seconds(), cycle.t_effect.seconds(), 0.0011);
    EXPECT_EQ(world_.submissions[told].start, cycle.plan_start);
    ++told;
  }
  EXPECT_EQ(told, world_.submissions.size());
}

TEST_P(EpisodeTiming, NeverAsksForAJumpOfPositionOrVelocity) {
  scenario_.replan_rate_hz = GetParam().rate_hz;
  scenario_.latency_s = GetParam().latency_s;
  const EpisodeResult result = Run();
  const std::vector<ControlSample>& control = result.recording.control;
  const double tick_s = 0.001, a_max = 10;  // of the planar arm
  for (std::size_t i = 1; i < control.size(); ++i) {
    const Eigen::VectorXd dv = control[i].v - control[i - 1].v;
    const Eigen::VectorXd dq =
        control[i].q - control[i - 1].q - tick_s / 2 * (control[i].v + control[i - 1].v);
    EXPECT_LT(dv.cwiseAbs().maxCoeff(), 1.05 * a_max * tick_s) << control[i].t.seconds();
    EXPECT_LT(dq.cwiseAbs().maxCoeff(), 1e-5) << control[i].t.seconds();
  }
}

INSTANTIATE_TEST_SUITE_P(RateAndLatency, EpisodeTiming,
                         ::testing::Values(Timing{10, 0.1, 0.1}, Timing{10, 0, 0.1},
                                           Timing{10, 0.03, 0.1}, Timing{10, 0.25, 0.3},
                                           Timing{4, 0.1, 0.25}, Timing{30, 0.1, 0.1}));

TEST_F(Episode, IsTheSameTwice) {
  const EpisodeResult a = Run(), b = Run();
  ASSERT_EQ(a.recording.control.size(), b.recording.control.size());
  for (std::size_t i = 0; i < a.recording.control.size(); ++i) {
    ASSERT_EQ(a.recording.control[i].q, b.recording.control[i].q);
  }
  for (const auto& [name, value] : a.recording.metrics) {
    const double again = b.recording.metrics.at(name);
    EXPECT_TRUE(value == again || (std::isnan(value) && std::isnan(again))) << name;
  }
}

}  // namespace
}  // namespace sidestep::bench
