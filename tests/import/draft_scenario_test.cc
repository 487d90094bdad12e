#include "sidestep/import/draft_scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <ostream>
#include <string>

#include "sidestep/import/commented_yaml.h"
#include "sidestep/import/free_space.h"

namespace sidestep::imports::draft_scenario_test {
namespace {

struct Robot {
  std::string models, name;
  double floor_m;
};
void PrintTo(const Robot& robot, std::ostream* out) { *out << robot.name; }

class EveryRobot : public ::testing::TestWithParam<Robot> {
 protected:
  scenarios::Scenario Draft(std::uint64_t seed) const {
    scenarios::Scenario scenario = DraftScenario(robot_);
    scenario.floor_m = GetParam().floor_m;
    scenario.name = "draft";
    scenario.description = "A draft";
    scenario.seed = seed;
    RandomStream random(seed, "task");
    EXPECT_TRUE(ChooseTask(scenario, robot_, random, [](const Eigen::VectorXd&) { return true; }));
    FitHorizon(scenario, robot_);
    AddCrossingBall(scenario, robot_);
    return scenario;
  }

  // Between the ball and the arm at a configuration.
  double Gap(const scenarios::Scenario& scenario, const Eigen::VectorXd& q, double t_s) const {
    const scenarios::MovingObstacle& ball = scenario.moving_obstacles.front();
    const Eigen::Vector3d p = PoseAt(ball, EpisodeTime(t_s)).translation();
    const Eigen::Matrix3Xd p_WS = robot_.ComputeSphereCenters(q, false).p_WS;
    double least_m = std::numeric_limits<double>::infinity();
    for (int s = 0; s < robot_.num_spheres(); ++s) {
      least_m = std::min(least_m,
                         SignedDistance(ball.shape, p_WS.col(s) - p) - robot_.sphere_radii_m()(s));
    }
    return least_m;
  }

  const robot::RobotModel robot_ =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR + GetParam().models, GetParam().name, Pose());
};

TEST_P(EveryRobot, HasAFreeStartAndGoalWithAFreeWayBetween) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const scenarios::Scenario scenario = Draft(seed);
    const FreeSpace space(scenario, robot_);
    for (const double share : {0.0, 0.2, 0.5, 0.8, 1.0}) {
      const Eigen::VectorXd q = scenario.q_start + share * (scenario.q_goal - scenario.q_start);
      EXPECT_GT(space.Clearance(q), 0) << "seed " << seed << ", at " << share;
    }
    EXPECT_GT((scenario.q_goal - scenario.q_start).norm(), 0.2);
  }
}

// The straight motion, as DirectDuration_s has it, runs into the ball; resting at either end is
// safe.
TEST_P(EveryRobot, IsCrossedByTheBallOnItsStraightWay) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const scenarios::Scenario scenario = Draft(seed);
    const Eigen::VectorXd way = scenario.q_goal - scenario.q_start;
    const double duration_s = DirectDuration_s(scenario, robot_, scenario.q_start, scenario.q_goal);
    double nearest_m = std::numeric_limits<double>::infinity();
    for (double s = 0; s <= 1; s += 0.01) {
      const double share = s * s * s * (10 + s * (6 * s - 15));
      nearest_m =
          std::min(nearest_m, Gap(scenario, scenario.q_start + share * way, s * duration_s));
    }
    EXPECT_LT(nearest_m, -0.01) << "seed " << seed;
    EXPECT_GT(Gap(scenario, scenario.q_start, 0), 0.02) << "seed " << seed;
    for (double t_s = duration_s; t_s < 3 * duration_s; t_s += 0.1) {
      EXPECT_GT(Gap(scenario, scenario.q_goal, t_s), 0) << "seed " << seed << " at " << t_s;
    }
  }
}

TEST_P(EveryRobot, KeepsItsLimitsOnTheStraightWay) {
  const scenarios::Scenario scenario = Draft(1);
  const Eigen::VectorXd way = scenario.q_goal - scenario.q_start;
  const double T = DirectDuration_s(scenario, robot_, scenario.q_start, scenario.q_goal);
  double use = 0;
  for (double s = 0; s <= 1; s += 0.001) {
    const double speed = 30 * s * s * (1 - s) * (1 - s) / T;
    const double acceleration = 60 * s * (1 - s) * (1 - 2 * s) / (T * T);
    for (int i = 0; i < robot_.num_joints(); ++i) {
      const robot::JointLimits& limits = robot_.limits()[static_cast<std::size_t>(i)];
      use = std::max({use, std::abs(speed * way(i)) / (0.95 * limits.v_max),
                      std::abs(acceleration * way(i)) / (0.5 * limits.a_max)});
    }
  }
  EXPECT_NEAR(use, 1, 1e-3);
}

TEST_P(EveryRobot, FindsItsReachInTheWorkspace) {
  const scenarios::Scenario scenario = Draft(1);
  for (const Eigen::VectorXd& q : {scenario.q_start, scenario.q_goal}) {
    const Eigen::Matrix3Xd p_WS = robot_.ComputeSphereCenters(q, false).p_WS;
    for (int s = 0; s < robot_.num_spheres(); ++s) {
      const auto cell = scenario.grid.CellOf(p_WS.col(s));
      EXPECT_TRUE(scenario.grid.Contains(cell[0], cell[1], cell[2]));
    }
  }
}

TEST_P(EveryRobot, IsWrittenWithCommentsThatChangeNothing) {
  const scenarios::Scenario scenario = Draft(1);
  const std::string text = CommentedYaml(scenario, {"Head", "", "more"});
  EXPECT_EQ(text.rfind("# Head\n#\n# more\n", 0), 0u);
  EXPECT_EQ(ToYaml(scenarios::ParseScenario(text, "draft.yaml")), ToYaml(scenario));
  EXPECT_GT(std::count(text.begin(), text.end(), '#'), 20);
}

INSTANTIATE_TEST_SUITE_P(Known, EveryRobot,
                         ::testing::Values(Robot{"/models", "panda", 0},
                                           Robot{"/models", "wam", -0.346},
                                           Robot{"/examples/robot", "panda_rail", 0},
                                           Robot{"/examples/robot", "pointer", 0}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep::imports::draft_scenario_test
