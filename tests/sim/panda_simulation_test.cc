// The shipped Panda in the shipped scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sidestep/sim/simulation.h"

namespace sidestep::sim::panda_simulation_test {
namespace {

const std::string kModels = SIDESTEP_SOURCE_DIR "/models";

scenarios::Scenario Walkway() {
  return scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml");
}

robot::RobotModel Panda(const scenarios::Scenario& scenario) {
  return robot::RobotModel::Load(kModels, scenario.robot, scenario.X_WB);
}

class EveryConfiguration : public testing::TestWithParam<std::string> {};

TEST_P(EveryConfiguration, IsHeldUntouched) {
  scenarios::Scenario scenario = Walkway();
  scenario.moving_obstacles.clear();
  scenario.start_name = GetParam();
  const robot::RobotModel robot = Panda(scenario);
  Simulation simulation(scenario, robot, kModels);
  simulation.robot().AdvanceTo(EpisodeTime(1));
  const Eigen::VectorXd error = simulation.robot().Read().q - robot.configurations().at(GetParam());
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-3);
  for (const TruthSample& sample : simulation.truth().TakeSamples()) {
    ASSERT_FALSE(sample.in_contact) << sample.contact_object << " at " << sample.contact_s;
    ASSERT_GT(sample.clearance_m, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Panda, EveryConfiguration,
                         testing::Values("home", "ready", "right_ready", "pickup_right",
                                         "pickup_left", "table_forward", "table_right",
                                         "table_left", "table_forward_horz", "table_left_horz",
                                         "table_right_horz"),
                         [](const auto& test) { return test.param; });

TEST(Panda, FollowsAQuarterTurnInTwoSeconds) {
  scenarios::Scenario scenario = Walkway();
  scenario.moving_obstacles.clear();
  const robot::RobotModel robot = Panda(scenario);
  Simulation simulation(scenario, robot, kModels);
  const Eigen::VectorXd q_start = robot.configurations().at("right_ready");
  const Eigen::VectorXd q_goal = robot.configurations().at("ready");  // a quarter turn of joint 1
  constexpr int kStates = 21;
  Trajectory motion;
  motion.t_s = Eigen::VectorXd::LinSpaced(kStates, 0, 2);
  motion.q.resize(7, kStates);
  motion.v.resize(7, kStates);
  for (int k = 0; k < kStates; ++k) {  // the quintic of least jerk, its peak 1.47 rad/s
    const double s = motion.t_s(k) / 2;
    motion.q.col(k) = q_start + s * s * s * (10 - 15 * s + 6 * s * s) * (q_goal - q_start);
    motion.v.col(k) = 15 * s * s * (1 - s) * (1 - s) * (q_goal - q_start);
  }
  simulation.robot().Submit(motion, EpisodeTime(0));
  simulation.robot().AdvanceTo(EpisodeTime(3));

  double worst_command = 0, worst_motion = 0;
  Eigen::VectorXd largest_torque = Eigen::VectorXd::Zero(7);
  const std::vector<ControlSample> log = simulation.robot().TakeControlLog();
  for (const ControlSample& sample : log) {
    const Eigen::VectorXd q = Sample(motion, sample.t - EpisodeTime(0)).q;
    worst_command = std::max(worst_command, (sample.q_command - q).cwiseAbs().maxCoeff());
    worst_motion = std::max(worst_motion, (sample.q - q).cwiseAbs().maxCoeff());
    largest_torque = largest_torque.cwiseMax(sample.torque.cwiseAbs());
  }
  RecordProperty("worst_command_error_mrad", std::to_string(1e3 * worst_command));
  RecordProperty("worst_motion_error_mrad", std::to_string(1e3 * worst_motion));
  EXPECT_LT(worst_command, 1e-3);
  EXPECT_LT(worst_motion, 5e-3);
  EXPECT_GT(worst_motion, 1e-4);  // inertia and friction are not compensated
  EXPECT_LT((log.back().q - q_goal).cwiseAbs().maxCoeff(), 1e-3);
  for (int i = 0; i < 7; ++i) {
    EXPECT_LE(largest_torque(i), robot.limits()[static_cast<std::size_t>(i)].torque_max);
  }
}

TEST(Panda, IsTouchedByTheHsrWhenItReachesAcrossTheWalkway) {
  scenarios::Scenario scenario = Walkway();
  scenario.start_name = "table_forward";
  Simulation simulation(scenario, Panda(scenario), kModels);
  simulation.robot().AdvanceTo(EpisodeTime(1.6));
  const std::vector<TruthSample> samples = simulation.truth().TakeSamples();
  const auto contact =
      std::find_if(samples.begin(), samples.end(), [](const auto& s) { return s.in_contact; });
  ASSERT_NE(contact, samples.end());
  EXPECT_EQ(contact->contact_object, "hsr");
  // The box's front, at y = 2 - 0.275 - 1.4 t, meets the arm, which reaches along x at y near 0
  // and is no more than 0.15 m wide to that side.
  EXPECT_GT(contact->contact_s, (2 - 0.275 - 0.15) / 1.4);
  EXPECT_LT(contact->contact_s, (2 - 0.275) / 1.4);
  EXPECT_NEAR(contact->p_WContact.y(), 2 - 0.275 - 1.4 * contact->contact_s, 2e-3);
}

}  // namespace
}  // namespace sidestep::sim::panda_simulation_test
