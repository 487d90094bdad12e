#include "sidestep/planner/gp_planner.h"

#include <gtest/gtest.h>

#include "sidestep/planner/clearance.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/gp_trajectory.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::gp_planner_test {
namespace {

PlannerSettings WithoutLimits() {
  PlannerSettings settings;
  settings.position_limits = settings.velocity_limits = settings.acceleration_limits = false;
  return settings;
}

class GpPlannerTest : public ::testing::Test {
 protected:
  PlanRequest Request(const sdf::DistanceField& field) const {
    PlanRequest request;
    request.field = &field;
    request.step_s = 0.1;
    request.num_states = 31;
    request.q_start = Eigen::Vector2d(-1.1, 0.3);
    request.v_start = Eigen::Vector2d::Zero();
    request.q_goal = Eigen::Vector2d(1.2, -0.2);
    return request;
  }

  const robot::RobotModel arm_ = MakePlanarArm();
  const BallField nothing_{{100, 0, 0}, {0, 0, 0}, 0.1};
};

TEST_F(GpPlannerTest, TakesTheCubicToTheGoalWhereNothingIsInTheWay) {
  PlanRequest request = Request(nothing_);
  request.v_start = Eigen::Vector2d(0.5, -0.2);
  const PlanResult result = GpPlanner(arm_, {}).Plan(request);
  const Trajectory cubic = MakeDirectMotion(request, Timing::kWholeTime);
  EXPECT_EQ(result.status, PlanStatus::kSolved);
  EXPECT_LT((result.trajectory->q - cubic.q).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(result.cost.gp, ComputeGpCost(cubic, 1), 1e-6 * result.cost.gp);
  EXPECT_EQ(result.cost.obstacle, 0);
}

TEST_F(GpPlannerTest, FindsTheCubicFromAnyGuess) {
  PlanRequest request = Request(nothing_);
  request.initial = MakeDirectMotion(request, Timing::kLeaveLate);
  GpSettings gp;
  gp.function_tolerance = 1e-12;
  const PlanResult result = GpPlanner(arm_, WithoutLimits(), gp).Plan(request);
  EXPECT_LT((result.trajectory->q - MakeDirectMotion(request, Timing::kWholeTime).q)
                .cwiseAbs()
                .maxCoeff(),
            1e-5);
}

TEST_F(GpPlannerTest, BendsAroundABallThatTheDirectMotionHits) {
  const BallField ball({1.08, 0, 0}, {0, 0, 0}, 0.1);
  const PlanRequest request = Request(ball);
  const Trajectory direct = MakeDirectMotion(request, Timing::kWholeTime);
  EXPECT_LT(
      MeasureClearance(arm_, ball, direct, EpisodeTime(0), EpisodeTime(0), EpisodeTime(3)).least_m,
      -0.02);
  const PlanResult result = GpPlanner(arm_, {}).Plan(request);
  EXPECT_EQ(result.status, PlanStatus::kSolved);
  EXPECT_GT(result.clearance.least_m, 0.02);
  EXPECT_LE(result.limit_use.velocity, 1);
  EXPECT_LE(result.limit_use.acceleration, 1);
}

TEST_F(GpPlannerTest, TakesADetourWhereNoTimingHelps) {
  // The ball stands where the forearm would sweep; the elbow must fold first.
  const BallField ball({0.8, 0, 0}, {0, 0, 0}, 0.05);
  PlannerSettings settings;
  GpSettings gp;
  gp.num_detours = 0;
  EXPECT_EQ(GpPlanner(arm_, settings, gp).Plan(Request(ball)).status, PlanStatus::kInCollision);
  gp.num_detours = 8;
  const PlanResult result = GpPlanner(arm_, settings, gp).Plan(Request(ball));
  EXPECT_GT(result.clearance.least_m, 0.1);
  // The few iterations of a trial leave a little of an excess over the velocity that was asked for.
  EXPECT_LE(result.limit_use.velocity, 1.01 * settings.velocity_scale);
}

TEST_F(GpPlannerTest, MeetsAMovingBallNeitherWhereItWasNorWhereItWillBe) {
  // The ball goes before the arm along the arm's own circle, so that the direct motion is free
  // though it passes every place where the ball ever was.
  const BallField ahead({0.9, -0.2, 0}, {0, 0.75, 0}, 0.05);
  PlannerSettings settings;
  settings.epsilon_m = 0.02;
  const PlanRequest request = Request(ahead);
  const PlanResult result = GpPlanner(arm_, settings).Plan(request);
  EXPECT_EQ(result.status, PlanStatus::kSolved);
  EXPECT_LT((result.trajectory->q - MakeDirectMotion(request, Timing::kWholeTime).q)
                .cwiseAbs()
                .maxCoeff(),
            1e-6);
}

TEST_F(GpPlannerTest, KeepsWithinLimitsThatTheFreeOptimumBreaks) {
  PlanRequest request = Request(nothing_);
  request.num_states = 20;  // 1.9 s for 2.3 rad: 1.82 rad/s at the peak of the cubic
  PlannerSettings settings;
  settings.velocity_scale = settings.acceleration_scale = 0.8;  // 1.6 rad/s
  const PlanResult result = GpPlanner(arm_, settings).Plan(request);
  const LimitUse without = GpPlanner(arm_, WithoutLimits()).Plan(request).limit_use;
  EXPECT_GT(without.velocity, 0.9);
  EXPECT_EQ(result.status, PlanStatus::kSolved);
  EXPECT_LT(result.limit_use.velocity, 0.82);
  EXPECT_LT(result.limit_use.acceleration, 0.82);
}

TEST_F(GpPlannerTest, ReportsTheIterationCap) {
  const BallField ball({1.08, 0, 0}, {0, 0, 0}, 0.02);
  PlannerSettings settings = WithoutLimits();  // one iteration does not come to keep them
  GpSettings gp;
  gp.max_iterations = 1;
  gp.function_tolerance = 1e-12;
  const PlanResult result = GpPlanner(arm_, settings, gp).Plan(Request(ball));
  EXPECT_EQ(result.status, PlanStatus::kNotConverged);
}

TEST_F(GpPlannerTest, AWarmStartFromItsOwnPlanChangesLittleAndCostsLittle) {
  const BallField ball({1.08, 0, 0}, {0, 0, 0}, 0.1);
  PlanRequest request = Request(ball);
  const GpPlanner planner(arm_, {});
  const PlanResult cold = planner.Plan(request);
  request.initial = cold.trajectory;
  const PlanResult warm = planner.Plan(request);
  EXPECT_LT(warm.iterations, cold.iterations);
  EXPECT_LE(warm.cost.total(), cold.cost.total() * (1 + 1e-9));
  EXPECT_LT((warm.trajectory->q - cold.trajectory->q).cwiseAbs().maxCoeff(), 0.05);
}

}  // namespace
}  // namespace sidestep::planner::gp_planner_test
