#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "core/input_error.h"
#include "tests/sim/two_link.h"

namespace sidestep {
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

Simulation MakeTwoLink(const Scenario& scenario) {
  return Simulation(scenario, TwoLink(scenario), kTestModels);
}

TEST(Simulation, HoldsItsPoseAgainstGravity) {
  Scenario scenario = TwoLinkScenario();
  scenario.q_start = Eigen::Vector2d(0.3, 0.4);
  Simulation simulation = MakeTwoLink(scenario);
  simulation.robot().AdvanceTo(EpisodeTime(2));
  const JointState state = simulation.robot().Read();
  EXPECT_EQ(state.t, EpisodeTime(2));
  EXPECT_LT((state.q - scenario.q_start).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(state.v.cwiseAbs().maxCoeff(), 1e-6);
  // The motor holds the bar's weight: it does not rest on anything.
  EXPECT_GT(std::abs(simulation.robot().TakeControlLog().back().torque(1)), 1.0);
}

TEST(Simulation, FollowsASmoothMotion) {
  const Scenario scenario = TwoLinkScenario();
  Simulation simulation = MakeTwoLink(scenario);
  const Eigen::Vector2d q_goal(kPi / 2, 0.5);
  const Trajectory motion = SmoothMotion(scenario.q_start, q_goal, 2);
  simulation.robot().Submit(motion, EpisodeTime(0.1));
  simulation.robot().AdvanceTo(EpisodeTime(2.6));
  double worst = 0;
  for (const ControlSample& sample : simulation.robot().TakeControlLog()) {
    const Eigen::VectorXd q_wanted = Sample(motion, sample.t - EpisodeTime(0.1)).q;
    worst = std::max(worst, (sample.q - q_wanted).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst, 1e-5);  // a real controller lags
  EXPECT_LT((simulation.robot().Read().q - q_goal).norm(), 1e-3);
}

}  // namespace
}  // namespace sidestep
