#include "sidestep/sim/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sidestep/core/input_error.h"
#include "tests/sim/two_link.h"

namespace sidestep::sim::simulation_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

// From q_start to q_goal in `duration_s`, at rest at both ends: the quintic of least jerk, sampled.
Trajectory SmoothMotion(const Eigen::VectorXd& q_start, const Eigen::VectorXd& q_goal,
                        double duration_s) {
  constexpr int kStates = 41;
  Trajectory motion;
  motion.t_s = Eigen::VectorXd::LinSpaced(kStates, 0, duration_s);
  motion.q.resize(q_start.size(), kStates);
  motion.v.resize(q_start.size(), kStates);
  for (int k = 0; k < kStates; ++k) {
    const double s = motion.t_s(k) / duration_s;
    motion.q.col(k) = q_start + (s * s * s * (10 - 15 * s + 6 * s * s)) * (q_goal - q_start);
    motion.v.col(k) = 30 * s * s * (1 - s) * (1 - s) / duration_s * (q_goal - q_start);
  }
  return motion;
}

struct Log {
  std::vector<ControlSample> control;
  std::vector<TruthSample> truth;
};

// Everything that happens while the robot is told to move along `motion` from `start_s` on.
Log RunMotion(const scenarios::Scenario& scenario, const Trajectory& motion, double start_s,
              double end_s) {
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().Submit(motion, EpisodeTime(start_s));
  simulation.robot().AdvanceTo(EpisodeTime(end_s));
  return {simulation.robot().TakeControlLog(), simulation.truth().TakeSamples()};
}

void ExpectSameBits(const Log& a, const Log& b) {
  ASSERT_EQ(a.control.size(), b.control.size());
  ASSERT_EQ(a.truth.size(), b.truth.size());
  for (std::size_t i = 0; i < a.control.size(); ++i) {
    ASSERT_EQ(a.control[i].q, b.control[i].q) << "tick " << i;
    ASSERT_EQ(a.control[i].v, b.control[i].v) << "tick " << i;
    ASSERT_EQ(a.control[i].q_command, b.control[i].q_command) << "tick " << i;
    ASSERT_EQ(a.control[i].torque, b.control[i].torque) << "tick " << i;
  }
  for (std::size_t i = 0; i < a.truth.size(); ++i) {
    ASSERT_EQ(a.truth[i].clearance_m, b.truth[i].clearance_m) << "sample " << i;
    ASSERT_EQ(a.truth[i].in_contact, b.truth[i].in_contact) << "sample " << i;
    ASSERT_EQ(a.truth[i].p_WContact, b.truth[i].p_WContact) << "sample " << i;
  }
}

// The arm turns into a post that drives through.
scenarios::Scenario CrashScenario() {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.moving_obstacles = {
      Passing("post", Cylinder{0.05, 1}, {0.4, 0.8, 0.4}, {0, -1, 0}, 0.6)};
  return scenario;
}

TEST(Simulation, HoldsItsPoseAgainstGravity) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.q_start = Eigen::Vector2d(0.3, 0.4);
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().AdvanceTo(EpisodeTime(2));
  const JointState state = simulation.robot().Read();
  EXPECT_EQ(state.t, EpisodeTime(2));
  EXPECT_LT((state.q - scenario.q_start).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(state.v.cwiseAbs().maxCoeff(), 1e-6);
  // The motor holds the bar's weight: it does not rest on anything.
  EXPECT_GT(std::abs(simulation.robot().TakeControlLog().back().torque(1)), 1.0);
}

TEST(Simulation, FollowsASmoothMotion) {
  const scenarios::Scenario scenario = TwoLinkScenario();
  const Eigen::Vector2d q_goal(kPi / 2, 0.5);
  const Trajectory motion = SmoothMotion(scenario.q_start, q_goal, 2);
  const Log run = RunMotion(scenario, motion, 0.1, 2.6);
  double worst = 0;
  for (const ControlSample& sample : run.control) {
    const Eigen::VectorXd q_wanted = Sample(motion, sample.t - EpisodeTime(0.1)).q;
    worst = std::max(worst, (sample.q - q_wanted).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst, 1e-5);  // a real controller lags
  EXPECT_LT((run.control.back().q - q_goal).norm(), 1e-3);
}

TEST(Simulation, NeverExceedsATorqueLimit) {
  // Swept off its path by something that does not yield, the arm would need far more.
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.moving_obstacles = {
      Passing("ram", Box{{0.3, 0.3, 0.3}}, {0.5, 0.6, 0.3}, {0, -1, 0}, 1)};
  const Log run =
      RunMotion(scenario, SmoothMotion(scenario.q_start, Eigen::Vector2d(1, 0.5), 1), 0, 1.5);
  double largest = 0;
  for (const ControlSample& sample : run.control) {
    largest = std::max(largest, sample.torque.cwiseAbs().maxCoeff());
  }
  EXPECT_LE(largest, 40);
  EXPECT_GT(largest, 39.9);
}

TEST(Simulation, PushesOnAfterAContact) {
  const Log run = RunMotion(CrashScenario(),
                            SmoothMotion(Eigen::Vector2d(0, 0), Eigen::Vector2d(1.2, 0), 1), 0, 3);
  const auto in_contact = [](const TruthSample& sample) { return sample.in_contact; };
  EXPECT_TRUE(std::any_of(run.truth.begin(), run.truth.end(), in_contact));
  EXPECT_FALSE(run.truth.back().in_contact);
  EXPECT_LT((run.control.back().q - Eigen::Vector2d(1.2, 0)).norm(), 1e-3);  // and gets there
}

TEST(Simulation, FollowsWhatWasSubmittedBeforeUntilANewMotionStarts) {
  const scenarios::Scenario scenario = TwoLinkScenario();
  const Trajectory first = SmoothMotion(scenario.q_start, Eigen::Vector2d(0.6, 0), 1);
  const Trajectory second =
      SmoothMotion(Sample(first, HorizonOffset(0.5)).q, Eigen::Vector2d(0.3, 0.4), 1);
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().Submit(first, EpisodeTime(0));
  simulation.robot().Submit(second, EpisodeTime(0.5));
  simulation.robot().AdvanceTo(EpisodeTime(3));
  const Log undisturbed = RunMotion(scenario, first, 0, 0.5);
  const std::vector<ControlSample> log = simulation.robot().TakeControlLog();
  ASSERT_THAT(log, testing::SizeIs(3000));
  for (std::size_t i = 0; i < 500; ++i) {
    ASSERT_EQ(log[i].q, undisturbed.control[i].q) << "tick " << i;
    ASSERT_EQ(log[i].t.seconds(), static_cast<double>(i) / 1000);
  }
  EXPECT_LT((log.back().q - Eigen::Vector2d(0.3, 0.4)).norm(), 1e-3);
}

TEST(Simulation, DropsWhatWasToStartLaterThanANewMotion) {
  const scenarios::Scenario scenario = TwoLinkScenario();
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  const auto to = [&](double q) {
    return SmoothMotion(scenario.q_start, Eigen::Vector2d(q, 0), 0.5);
  };
  simulation.robot().Submit(to(1.0), EpisodeTime(0.6));
  simulation.robot().Submit(to(0.5), EpisodeTime(0.3));
  simulation.robot().AdvanceTo(EpisodeTime(2));
  EXPECT_NEAR(simulation.robot().Read().q(0), 0.5, 1e-3);
}

TEST(Simulation, JoinsAMotionThatHasAlreadyBegun) {
  const scenarios::Scenario scenario = TwoLinkScenario();
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().AdvanceTo(EpisodeTime(0.4));
  simulation.robot().Submit(SmoothMotion(scenario.q_start, Eigen::Vector2d(0.8, 0.1), 1),
                            EpisodeTime(0));
  simulation.robot().AdvanceTo(EpisodeTime(2));
  EXPECT_LT((simulation.robot().Read().q - Eigen::Vector2d(0.8, 0.1)).norm(), 1e-3);
}

TEST(Simulation, BrakesAndStaysWhenToldToHold) {
  const scenarios::Scenario scenario = TwoLinkScenario();
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().Submit(SmoothMotion(scenario.q_start, Eigen::Vector2d(2, 0), 1),
                            EpisodeTime(0));
  simulation.robot().AdvanceTo(EpisodeTime(0.5));
  const double v_before = simulation.robot().Read().v(0);
  EXPECT_GT(v_before, 3);
  simulation.robot().Hold();
  simulation.robot().AdvanceTo(EpisodeTime(1.5));
  const JointState stopped = simulation.robot().Read();
  EXPECT_LT(stopped.v.norm(), 1e-3);
  EXPECT_LT(stopped.q(0), 1.6);  // it had 1 rad to go
  simulation.robot().AdvanceTo(EpisodeTime(2.5));
  EXPECT_LT((simulation.robot().Read().q - stopped.q).norm(), 1e-4);
}

TEST(Simulation, AdvancesToTheFirstTickThatIsNotBefore) {
  const scenarios::Scenario scenario = TwoLinkScenario();
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  for (const auto& [t, tick] : {std::pair(0.0101, 0.011), {0.1 + 0.2, 0.3}, {0.2, 0.3}}) {
    simulation.robot().AdvanceTo(EpisodeTime(t));
    EXPECT_EQ(simulation.robot().Read().t, EpisodeTime(tick));  // and never back
  }
}

TEST(Simulation, RefusesATrajectoryThatDoesNotFit) {
  const scenarios::Scenario scenario = TwoLinkScenario();
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  Trajectory motion = SmoothMotion(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones(), 1);
  EXPECT_THROW(simulation.robot().Submit(motion, EpisodeTime(0)), std::invalid_argument);
  motion = SmoothMotion(Eigen::Vector2d::Zero(), Eigen::Vector2d::Ones(), 1);
  motion.q(0, 3) = std::nan("");
  EXPECT_THROW(simulation.robot().Submit(motion, EpisodeTime(0)), std::invalid_argument);
}

TEST(Simulation, GivesTheSameBitsAgain) {
  const Trajectory motion = SmoothMotion(Eigen::Vector2d(0, 0), Eigen::Vector2d(1.2, 0.2), 1);
  ExpectSameBits(RunMotion(CrashScenario(), motion, 0.1, 2),
                 RunMotion(CrashScenario(), motion, 0.1, 2));
}

TEST(Simulation, IsNotInfluencedByAnotherOneBesideIt) {
  const scenarios::Scenario scenario = CrashScenario();
  const Trajectory motion = SmoothMotion(Eigen::Vector2d(0, 0), Eigen::Vector2d(1.2, 0.2), 1);
  const Log alone = RunMotion(scenario, motion, 0.1, 2);
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().Submit(motion, EpisodeTime(0.1));
  Simulation other(scenario, TwoLink(scenario), kTestModels);
  other.robot().Submit(SmoothMotion(Eigen::Vector2d(0, 0), Eigen::Vector2d(-1, 0.5), 0.7),
                       EpisodeTime(0));
  for (double t = 0; t < 2; t += 0.0173) {
    simulation.robot().AdvanceTo(EpisodeTime(t));
    other.robot().AdvanceTo(EpisodeTime(t));
    simulation.sensor().Read(simulation.world().time());
    other.sensor().Read(other.world().time());
  }
  simulation.robot().AdvanceTo(EpisodeTime(2));
  ExpectSameBits(alone, {simulation.robot().TakeControlLog(), simulation.truth().TakeSamples()});
}

TEST(Simulation, FailsTheRunWhenThePhysicsDiverges) {
  // A controller of this stiffness is unstable at 1 kHz, and its motors have no limit.
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.robot = "explosive";
  const robot::RobotModel robot = robot::RobotModel::Load(kTestModels, "explosive", scenario.X_WB);
  Simulation simulation(scenario, robot, kTestModels);
  simulation.robot().Submit(SmoothMotion(scenario.q_start, Eigen::Vector2d(0.5, 0.5), 1),
                            EpisodeTime(0));
  EXPECT_THAT([&] { simulation.robot().AdvanceTo(EpisodeTime(1)); },
              testing::ThrowsMessage<SimulationError>(testing::AllOf(
                  testing::StartsWith("at 0."), testing::HasSubstr("simulation is unstable"))));
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

TEST(Simulation, SaysWhatOfTheScenarioDoesNotFit) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.q_start = {};
  scenario.start_name = "asleep";
  scenario.lines["task.start"] = 9;
  EXPECT_THAT([&] { Simulation(scenario, TwoLink(scenario), kTestModels); },
              testing::ThrowsMessage<InputError>(testing::StrEq(
                  "two_link.yaml:9: task.start: two_link has no configuration 'asleep'")));
  scenario.start_name = "level";
  scenario.sensor.name = "nose";
  scenario.lines["sensor"] = 12;
  EXPECT_THAT([&] { Simulation(scenario, TwoLink(scenario), kTestModels); },
              testing::ThrowsMessage<InputError>(
                  testing::StrEq("two_link.yaml:12: sensor.name: is not a known sensor (known: "
                                 "depth_camera, occupancy, tags): "
                                 "'nose'")));
}

}  // namespace
}  // namespace sidestep::sim::simulation_test
