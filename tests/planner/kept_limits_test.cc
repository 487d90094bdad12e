// Planners that search keep to the limits that they are asked for, wherever that can be had.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sidestep/planner/registry.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::kept_limits_test {
namespace {

struct Case {
  const char* planner;
  double velocity_scale, acceleration_scale;
  double times = 1;  // of what the direct motion takes
};
std::ostream& operator<<(std::ostream& stream, const Case& c) {
  return stream << c.planner << ", " << c.velocity_scale << ", " << c.acceleration_scale;
}

class KeptLimits : public ::testing::TestWithParam<Case> {};

// Round what stands in the way and what passes by, with little time to spare.
TEST_P(KeptLimits, AreNotExceededByWhatIsInTheWay) {
  const robot::RobotModel arm = MakePlanarArm();
  PlannerSettings settings;
  settings.epsilon_m = 0.1;
  settings.velocity_scale = GetParam().velocity_scale;
  settings.acceleration_scale = GetParam().acceleration_scale;
  const auto planner = MakePlanner(GetParam().planner, arm, settings);
  PlanRequest request;
  request.step_s = 0.1;
  request.q_start = Eigen::Vector2d(-1.1, 0.3);
  request.v_start = Eigen::Vector2d::Zero();
  request.q_goal = Eigen::Vector2d(1.2, -0.2);
  const double horizon_s =
      GetParam().times * planner->DirectTime_s(request.q_start, request.q_goal);
  request.num_states = static_cast<int>(std::ceil(horizon_s / request.step_s)) + 1;
  const BallField standing({1.05, 0, 0}, {0, 0, 0}, 0.1),
      passing({1.05, -0.2, 0}, {0, 0.4 / horizon_s, 0}, 0.1);
  for (const BallField* const field : {&standing, &passing}) {
    request.field = field;
    request.initial.reset();
    request.num_fixed = 1;
    for (int cycle = 0; cycle < 3; ++cycle) {  // the first is cold, the others start from it
      const PlanResult plan = planner->Plan(request);
      EXPECT_TRUE(plan.status == PlanStatus::kSolved || plan.status == PlanStatus::kNotConverged)
          << ToString(plan.status) << " in cycle " << cycle;
      EXPECT_LE(plan.limit_use.velocity, (1 + 1e-3) * settings.velocity_scale);
      EXPECT_LE(plan.limit_use.acceleration, (1 + 1e-3) * settings.acceleration_scale);
      request.initial = plan.trajectory;
      request.num_fixed = 4;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfPlannersThatSearch, KeptLimits,
                         ::testing::Values(Case{"gpmp", 0.2, 0.5}, Case{"gpmp_ceres", 0.2, 0.5},
                                           Case{"gpmp_fast", 0.2, 0.5},
                                           Case{"gpmp_fast", 0.95, 0.5, 1.5},
                                           Case{"gpmp_fast", 0.95, 0.02, 1.5},
                                           Case{"gpmp_fast", 0.05, 1}));

}  // namespace
}  // namespace sidestep::planner::kept_limits_test
