#include "sidestep/bench/outcome.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace sidestep::bench::outcome_test {
namespace {

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

struct Case {
  const char* name;
  bool has_truth;
  double first_contact_s;
  bool reached;
  double plans_accepted;
  Outcome outcome;
};
std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.name; }

class JudgedOutcome : public ::testing::TestWithParam<Case> {};

TEST_P(JudgedOutcome, IsTheFirstThatIsTrue) {
  const Case& c = GetParam();
  record::Recording recording;
  recording.truth.resize(c.has_truth ? 1 : 0);
  recording.metrics = {{"first_contact_s", c.first_contact_s},
                       {"plans_accepted", c.plans_accepted}};
  EXPECT_EQ(ToString(Judge(recording, c.reached)), ToString(c.outcome));
}

INSTANTIATE_TEST_SUITE_P(
    Of, JudgedOutcome,
    ::testing::Values(Case{"AContactAtTheGoal", true, 1.0, true, 3, Outcome::kCollision},
                      Case{"AContactWithoutAPlan", true, 1.0, false, 0, Outcome::kCollision},
                      Case{"TheGoal", true, kNever, true, 3, Outcome::kGoal},
                      Case{"TheGoalWithoutATruth", false, kNever, true, 3, Outcome::kUnjudged},
                      Case{"NoGoalWithoutATruth", false, kNever, false, 3, Outcome::kUnjudged},
                      Case{"NoPlanWithoutATruth", false, kNever, false, 0, Outcome::kUnjudged},
                      Case{"StandingAtTheGoalFromTheStart", true, kNever, true, 0, Outcome::kGoal},
                      Case{"NoGoal", true, kNever, false, 3, Outcome::kTimeout},
                      Case{"NoPlan", true, kNever, false, 0, Outcome::kPlannerFailed}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Outcome, IsReadBackFromItsWord) {
  for (const Outcome outcome : kAllOutcomes) {
    EXPECT_EQ(OutcomeFromString(ToString(outcome)), outcome);
  }
  EXPECT_FALSE(OutcomeFromString("success").has_value());
}

TEST(Outcome, IsToldWithWhatWasTouched) {
  EXPECT_EQ(Tell(Outcome::kCollision, "hsr", Outcome::kGoal), "collision with hsr");
  EXPECT_EQ(Tell(Outcome::kAborted, "hsr", Outcome::kTimeout), "aborted, touched hsr");
  EXPECT_EQ(Tell(Outcome::kCollision, "", Outcome::kGoal), "collision");
  EXPECT_EQ(Tell(Outcome::kGoal, "", Outcome::kGoal), "goal");
}

TEST(Outcome, ThatNobodyJudgedSaysHowTheEpisodeEnded) {
  const auto tell = [](double time_to_goal_s, double plans_accepted) {
    return Tell(Outcome::kUnjudged, "",
                Ending({{"time_to_goal_s", time_to_goal_s}, {"plans_accepted", plans_accepted}}));
  };
  EXPECT_EQ(tell(2.5, 3), "unjudged, goal");
  EXPECT_EQ(tell(0, 0), "unjudged, goal");
  EXPECT_EQ(tell(kNever, 3), "unjudged, timeout");
  EXPECT_EQ(tell(kNever, 0), "unjudged, planner_failed");
}

}  // namespace
}  // namespace sidestep::bench::outcome_test
