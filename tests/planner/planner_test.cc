// What the base class makes of what a planner answers.
#include "sidestep/planner/planner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/planner/first_guess.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::planner_test {
namespace {

using Answer = std::function<PlanAnswer(const PlanRequest&, PlanJudge&)>;

// Answers as it is told.
class Puppet final : public Planner {
 public:
  explicit Puppet(Answer answer, const PlannerSettings& settings = {})
      : Planner(MakePlanarArm(), settings), answer_(std::move(answer)) {}

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge& judge) const override {
    return answer_(request, judge);
  }
  Answer answer_;
};

const BallField kNothing({100, 0, 0}, {0, 0, 0}, 0.1);
const BallField kInTheWay({0.9, 0, 0}, {0, 0, 0}, 0.2);

PlanRequest Request(const BallField& field = kNothing) {
  PlanRequest request;
  request.field = &field;
  request.step_s = 0.1;
  request.num_states = 21;
  request.q_start = Eigen::Vector2d(-1.1, 0.3);
  request.v_start = Eigen::Vector2d::Zero();
  request.q_goal = Eigen::Vector2d(1.2, -0.2);
  request.num_fixed = 3;
  return request;
}

PlanAnswer Direct(const PlanRequest& request, PlanJudge&) {
  return {.trajectory = MakeDirectMotion(request, sidestep::planner::Timing::kWholeTime),
          .converged = true};
}

TEST(Planner, JudgesTheAnswerWhateverThePlannerThinksOfIt) {
  struct Case {
    const BallField& field;
    double velocity_scale;
    bool converged;
    PlanStatus status;
  };
  // The direct motion takes 0.96 of the velocity limit.
  for (const Case& c : {Case{kNothing, 1, true, PlanStatus::kSolved},
                        Case{kNothing, 1, false, PlanStatus::kNotConverged},
                        Case{kNothing, 0.5, true, PlanStatus::kOverLimits},
                        Case{kInTheWay, 0.5, true, PlanStatus::kInCollision}}) {
    PlannerSettings settings;
    settings.velocity_scale = c.velocity_scale;
    settings.acceleration_limits = false;
    const Puppet puppet(
        [&](const PlanRequest& request, PlanJudge& judge) {
          PlanAnswer answer = Direct(request, judge);
          answer.converged = c.converged;
          return answer;
        },
        settings);
    const PlanResult result = puppet.Plan(Request(c.field));
    EXPECT_EQ(result.status, c.status) << ToString(result.status);
    EXPECT_TRUE(result.trajectory);
    EXPECT_EQ(result.reason, "");
  }
}

TEST(Planner, TellsAPlannerOfAMotionWhatItWillSayOfTheAnswer) {
  Verdict told;
  const Puppet puppet([&](const PlanRequest& request, PlanJudge& judge) {
    PlanAnswer answer = Direct(request, judge);
    told = judge.Judge(*answer.trajectory);
    return answer;
  });
  const PlanResult result = puppet.Plan(Request(kInTheWay));
  EXPECT_FALSE(told.is_free());
  EXPECT_EQ(result.clearance.least_m, told.clearance.least_m);
  EXPECT_EQ(result.limit_use.velocity, told.limit_use.velocity);
}

TEST(Planner, KnowsHowLongTheDirectMotionTakesWithinItsLimits) {
  for (const double scale : {0.05, 0.3, 1.0}) {
    PlannerSettings settings;
    settings.velocity_scale = scale;
    settings.acceleration_scale = 0.5 * scale;
    const Puppet puppet(Direct, settings);
    PlanRequest request = Request();
    request.num_fixed = 1;
    const double time_s = puppet.DirectTime_s(request.q_start, request.q_goal);
    request.step_s = time_s / (request.num_states - 1);
    EXPECT_EQ(puppet.Plan(request).status, PlanStatus::kSolved) << scale;
    request.step_s *= 0.99;
    EXPECT_EQ(puppet.Plan(request).status, PlanStatus::kOverLimits) << scale;
  }
}

TEST(Planner, KnowsHowLongTheDirectMotionTakesForItsTool) {
  PlannerSettings settings;
  settings.velocity_limits = settings.acceleration_limits = false;
  settings.tool_speed_m_s = 0.25;
  const Puppet puppet(Direct, settings);
  // Stretched out, the tool goes round a circle of 1 m; of the cubic the greatest speed is 3/2 of
  // the way over the time.
  const Eigen::Vector2d from(0, 0), to(0.8, 0);
  EXPECT_NEAR(puppet.DirectTime_s(from, to), 1.5 * 0.8 / 0.25, 1e-3 * 4.8);
}

// A trajectory that does not answer the request, and what is said of it.
struct Broken {
  std::string name;
  std::function<void(Trajectory&)> spoil;
  std::string reason;
};
void PrintTo(const Broken& broken, std::ostream* stream) { *stream << broken.name; }

class PlannerThatBreaksAPromise : public ::testing::TestWithParam<Broken> {};

TEST_P(PlannerThatBreaksAPromise, HasFailedAndItIsSaidWhy) {
  const Puppet puppet([](const PlanRequest& request, PlanJudge& judge) {
    PlanAnswer answer = Direct(request, judge);
    GetParam().spoil(*answer.trajectory);
    return answer;
  });
  const PlanResult result = puppet.Plan(Request());
  EXPECT_EQ(result.status, PlanStatus::kFailed);
  EXPECT_FALSE(result.trajectory);
  EXPECT_NE(result.reason.find(GetParam().reason), std::string::npos) << result.reason;
}

INSTANTIATE_TEST_SUITE_P(
    Promises, PlannerThatBreaksAPromise,
    ::testing::Values(
        Broken{
            "NotFinite",
            [](Trajectory& motion) { motion.q(0, 20) = std::numeric_limits<double>::quiet_NaN(); },
            "finite"},
        Broken{"AnotherGrid", [](Trajectory& motion) { motion.t_s *= 1.5; }, "grid"},
        Broken{"TooShort",
               [](Trajectory& motion) {
                 motion = {motion.t_s.head(20).eval(), motion.q.leftCols(20).eval(),
                           motion.v.leftCols(20).eval()};
               },
               "grid"},
        Broken{"TooManyJoints",
               [](Trajectory& motion) { motion.q = motion.v = Eigen::MatrixXd::Zero(3, 21); },
               "3 joints, not 2"},
        Broken{"AnotherStart", [](Trajectory& motion) { motion.q(1, 0) += 1e-12; }, "state 0"},
        Broken{"AnotherFixedState", [](Trajectory& motion) { motion.v(0, 2) = 1e-12; }, "state 2"},
        Broken{"Empty", [](Trajectory& motion) { motion = {}; }, "K >= 1"}),
    [](const auto& test) { return test.param.name; });

TEST(Planner, HasFailedWithTheWordsOfWhatItThrows) {
  const Puppet puppet([](const PlanRequest&, PlanJudge&) -> PlanAnswer {
    throw std::runtime_error("the solver is not at home");
  });
  const PlanResult result = puppet.Plan(Request());
  EXPECT_EQ(result.status, PlanStatus::kFailed);
  EXPECT_EQ(result.reason, "the solver is not at home");
}

TEST(Planner, MayFindNothingAndSaysWhy) {
  const Puppet silent([](const PlanRequest&, PlanJudge&) { return PlanAnswer{}; });
  EXPECT_EQ(silent.Plan(Request()).status, PlanStatus::kFailed);
  EXPECT_EQ(silent.Plan(Request()).reason, "found no plan");
  const Puppet outspoken([](const PlanRequest&, PlanJudge&) {
    return PlanAnswer{.iterations = 7, .why_none = "the goal is walled in"};
  });
  EXPECT_EQ(outspoken.Plan(Request()).reason, "the goal is walled in");
  EXPECT_EQ(outspoken.Plan(Request()).iterations, 7);
}

TEST(Planner, HasTimedOutIfItsBudgetWasSpentWithoutAPlan) {
  const Puppet puppet([](const PlanRequest&, PlanJudge&) { return PlanAnswer{.iterations = 7}; });
  PlanRequest request = Request();
  request.budget.iterations = 7;
  EXPECT_EQ(puppet.Plan(request).status, PlanStatus::kTimedOut);
  request.budget.iterations = 8;
  EXPECT_EQ(puppet.Plan(request).status, PlanStatus::kFailed);
  std::atomic<bool> stop = true;
  request.budget.stop = &stop;
  EXPECT_EQ(puppet.Plan(request).status, PlanStatus::kTimedOut);
  stop = false;
  request.budget.deadline = std::chrono::steady_clock::now();
  EXPECT_EQ(puppet.Plan(request).status, PlanStatus::kTimedOut);
}

}  // namespace
}  // namespace sidestep::planner::planner_test
