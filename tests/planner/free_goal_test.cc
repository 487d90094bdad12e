#include "sidestep/planner/free_goal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "sidestep/core/random.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/registry.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::free_goal_test {
namespace {

const EpisodeTime kThen(2.5);

double Clearance_m(const robot::RobotModel& robot, const sdf::DistanceField& field,
                   const Eigen::VectorXd& q) {
  const Trajectory there = {Eigen::VectorXd::Zero(1), q, Eigen::VectorXd::Zero(q.size())};
  return MeasureClearance(robot, field, there, kThen, kThen, kThen).least_m;
}

// By looking everywhere: how far the nearest configuration that keeps `clearance_m` is.
double NearestByBruteForce(const robot::RobotModel& robot, const sdf::DistanceField& field,
                           const Eigen::Vector2d& q_goal, double clearance_m) {
  double nearest = std::numeric_limits<double>::infinity();
  for (double a = -2; a <= 2; a += 0.02) {
    for (double b = -2; b <= 2; b += 0.02) {
      const Eigen::Vector2d off(a, b);
      if (off.norm() >= nearest) continue;
      if (Clearance_m(robot, field, q_goal + off) >= clearance_m) nearest = off.norm();
    }
  }
  return nearest;
}

TEST(FindFreeGoal, FindsAPlaceThatKeepsHalfTheMarginAndIsNearlyTheNearest) {
  const robot::RobotModel arm = MakePlanarArm();
  PlannerSettings settings;
  settings.epsilon_m = 0.1;
  RandomStream random(1, "blocked goals");
  int num_blocked = 0;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector2d q_goal(random.Uniform(-1.5, 1.5), random.Uniform(-1, 1));
    const Eigen::Matrix3Xd p_WS = arm.ComputeSphereCenters(q_goal, false).p_WS;
    const Eigen::Vector3d beside(random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1), 0);
    // Beside the arm's end, where it comes to be at that time.
    const Eigen::Vector3d v_W(0.3, -0.2, 0);
    const BallField field(p_WS.col(5) + beside - kThen.seconds() * v_W, v_W, 0.08);
    if (!IsBlocked(arm, field, q_goal, kThen)) continue;
    ++num_blocked;
    SCOPED_TRACE(i);
    const auto found = FindFreeGoal(arm, field, settings, q_goal, kThen);
    ASSERT_TRUE(found.has_value());
    EXPECT_FALSE(IsBlocked(arm, field, *found, kThen));
    EXPECT_GE(Clearance_m(arm, field, *found), 0.05);
    // As far as a descent goes: it keeps up to the whole margin, and goes one way round.
    EXPECT_LT((*found - q_goal).norm(), 0.1 + 2.5 * NearestByBruteForce(arm, field, q_goal, 0.05));
  }
  EXPECT_GT(num_blocked, 15);
}

TEST(FindFreeGoal, FindsNoneWhereThereIsNone) {
  const robot::RobotModel arm = MakePlanarArm();
  const BallField everywhere({0, 0, 0}, {0, 0, 0}, 3);
  EXPECT_TRUE(IsBlocked(arm, everywhere, Eigen::Vector2d::Zero(), kThen));
  EXPECT_FALSE(FindFreeGoal(arm, everywhere, {}, Eigen::Vector2d::Zero(), kThen).has_value());
}

TEST(PlannersThatSearch, WaitBesideAGoalThatIsBlockedAndSaySo) {
  const robot::RobotModel arm = MakePlanarArm();
  PlanRequest request;
  request.step_s = 0.1;
  request.num_states = 31;
  request.q_start = Eigen::Vector2d(-1.1, 0.3);
  request.v_start = Eigen::Vector2d::Zero();
  request.q_goal = Eigen::Vector2d(1.2, -0.2);
  const Eigen::Vector3d tip = arm.ComputeSphereCenters(request.q_goal, false).p_WS.col(5);
  const BallField at_goal(tip + Eigen::Vector3d(0.02, 0.05, 0), {0, 0, 0}, 0.1);
  const BallField nothing({100, 0, 0}, {0, 0, 0}, 0.1);
  PlannerSettings settings;
  settings.epsilon_m = 0.1;
  for (const std::string name : {"gpmp", "gpmp_ceres", "gpmp_fast"}) {
    SCOPED_TRACE(name);
    const auto planner = MakePlanner(name, arm, settings);
    request.field = &at_goal;
    request.initial.reset();
    const PlanResult cold = planner->Plan(request);
    EXPECT_EQ(ToString(cold.status), "short_of_goal");
    EXPECT_EQ(cold.reason, "the goal is blocked when the horizon ends");
    EXPECT_GT(cold.clearance.least_m, 0.02);
    EXPECT_LT(cold.trajectory->v.rightCols<1>().norm(), 1e-3);
    // One that is under way learns of it, then goes on like that, then finds that the goal is free.
    request.field = &nothing;
    request.initial = planner->Plan(request).trajectory;
    request.field = &at_goal;
    request.num_fixed = 4;
    for (int cycle = 0; cycle < 2; ++cycle) {
      const PlanResult warm = planner->Plan(request);
      EXPECT_EQ(ToString(warm.status), "short_of_goal") << cycle;
      request.initial = warm.trajectory;
    }
    request.field = &nothing;
    const PlanResult again = planner->Plan(request);
    EXPECT_EQ(ToString(again.status), "solved");
    EXPECT_EQ(again.reason, "");
    EXPECT_LT((again.trajectory->q.rightCols<1>() - request.q_goal).cwiseAbs().maxCoeff(), 1e-3);
  }
}

}  // namespace
}  // namespace sidestep::planner::free_goal_test
