#include "sidestep/core/goal.h"

#include <gtest/gtest.h>

#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace sidestep::goal_test {
namespace {

const Eigen::Vector2d kGoal(0.5, -1), kRest(0, 0);

TEST(Goal, IsReachedByAllJointsWithinTheToleranceAndSlowerThanTheSpeed) {
  EXPECT_TRUE(IsAtGoal(kGoal, kRest, kGoal));
  EXPECT_TRUE(
      IsAtGoal(kGoal + Eigen::Vector2d(0.0199, -0.0199), Eigen::Vector2d(0.0499, -0.0499), kGoal));
  EXPECT_FALSE(IsAtGoal(kGoal + Eigen::Vector2d(0, -0.0201), kRest, kGoal));
  EXPECT_FALSE(IsAtGoal(kGoal, Eigen::Vector2d(0, -0.0501), kGoal));
}

TEST(Goal, IsAskedOfPlansMoreStrictlyThanOfTheArmThatLagsThem) {
  EXPECT_LT(kPlannedGoalTolerance_rad, kGoalTolerance_rad);
}

TEST(Goal, IsWhereAPlanToItEnds) {
  const Eigen::Vector2d scale(1, 0.25);
  const auto plan_to = [](const Eigen::Vector2d& q_end) {
    Trajectory plan{Eigen::Vector2d(0, 1), Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
    plan.q.col(1) = q_end;
    return plan;
  };
  EXPECT_TRUE(EndsAtGoal(plan_to(kGoal + Eigen::Vector2d(0.0099, -0.0099)), kGoal));
  EXPECT_FALSE(EndsAtGoal(plan_to(kGoal + Eigen::Vector2d(0.0101, 0)), kGoal));
  EXPECT_TRUE(EndsAtGoal(plan_to(kGoal + Eigen::Vector2d(0, 0.00249)), kGoal, scale));
  EXPECT_FALSE(EndsAtGoal(plan_to(kGoal + Eigen::Vector2d(0, 0.00251)), kGoal, scale));
}

// Ticks of 0.1 s; each letter says whether the arm is at its goal (x) or elsewhere (-).
struct Stay {
  const char* name;
  double dwell_s;
  std::string ticks;
  std::optional<double> arrived_s, dwelt_s;
};
std::ostream& operator<<(std::ostream& stream, const Stay& stay) { return stream << stay.name; }

TEST(Goal, IsJudgedOfASlideByMetres) {
  const Eigen::Vector2d scale(1, 0.25);
  EXPECT_TRUE(IsAtGoal(kGoal + Eigen::Vector2d(0.0199, 0.00499), kRest, kGoal, scale));
  EXPECT_FALSE(IsAtGoal(kGoal + Eigen::Vector2d(0, 0.00501), kRest, kGoal, scale));
  EXPECT_FALSE(IsAtGoal(kGoal, Eigen::Vector2d(0, 0.0126), kGoal, scale));
  EXPECT_EQ(LargestDifference(kGoal + Eigen::Vector2d(0.125, -0.5), kGoal, scale), 2);
}

class GoalWatchOf : public ::testing::TestWithParam<Stay> {};

TEST_P(GoalWatchOf, TellsTheStayThatCounted) {
  GoalWatch watch(kGoal, GetParam().dwell_s);
  for (std::size_t i = 0; i < GetParam().ticks.size(); ++i) {
    const Eigen::Vector2d off(GetParam().ticks[i] == 'x' ? 0.01 : 0.3, 0);
    watch.Observe(EpisodeTime(0.1 * static_cast<double>(i)), kGoal + off, kRest);
  }
  const auto expect = [](std::optional<EpisodeTime> t, std::optional<double> expected_s) {
    ASSERT_EQ(t.has_value(), expected_s.has_value());
    if (t) {
      EXPECT_NEAR(t->seconds(), *expected_s, 1e-9);
    }
  };
  expect(watch.arrived(), GetParam().arrived_s);
  expect(watch.dwelt(), GetParam().dwelt_s);
}

INSTANTIATE_TEST_SUITE_P(Stays, GoalWatchOf,
                         ::testing::Values(Stay{"NeverThere", 0, "-----", {}, {}},
                                           Stay{"TheFirstTickWillDo", 0, "--x--", 0.2, 0.2},
                                           Stay{"TheFirstOfSeveralCounts", 0, "-xx-xx", 0.1, 0.1},
                                           Stay{"LongEnoughToTheTick", 0.3, "--xxxx", 0.2, 0.5},
                                           Stay{"OneTickShort", 0.3, "---xxx", 0.3, {}},
                                           Stay{"LeftTooSoon", 0.3, "-xxx--", {}, {}},
                                           Stay{"TheSecondStayCounts", 0.3, "-xx-xxxxx", 0.4, 0.7},
                                           Stay{"ReachedForGoodThoughItLeaves", 0.3, "xxxx--xx", 0,
                                                0.3}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::goal_test
