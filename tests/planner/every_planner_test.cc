// What every registered planner promises, the example's too, and what those can do that declare it.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "sidestep/planner/clearance.h"
#include "sidestep/planner/registry.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class EveryPlanner : public ::testing::TestWithParam<std::string> {
 protected:
  // Sweeps through where a ball passes by.
  PlanRequest Request() const {
    PlanRequest request;
    request.field = &field_;
    request.start = EpisodeTime(0.7);
    request.step_s = 0.1;
    request.num_states = 21;
    request.q_start = Eigen::Vector2d(-1.1, 0.3);
    request.v_start = Eigen::Vector2d(0.2, -0.1);
    request.q_goal = Eigen::Vector2d(1.2, -0.2);
    return request;
  }

  // The same with its first 8 states given, which no planner would choose.
  PlanRequest RequestWithFixedStates() const {
    PlanRequest request = Request();
    request.num_fixed = 8;
    request.initial = Trajectory{Eigen::VectorXd::LinSpaced(21, 0, 20) * 0.1,
                                 Eigen::MatrixXd(2, 21), Eigen::MatrixXd(2, 21)};
    for (int k = 0; k < 21; ++k) {
      request.initial->q.col(k) = Eigen::Vector2d(-1.1 + 0.1 * k, 0.3 + 0.01 * k * k);
      request.initial->v.col(k) = Eigen::Vector2d(0.2 + 0.03 * k, -0.1 - 0.01 * k);
    }
    return request;
  }

  PlanResult Plan(const PlanRequest& request) const {
    return MakePlanner(GetParam(), arm_, {})->Plan(request);
  }

  // Where the arm's end is.
  Eigen::Vector3d Tip(const Eigen::VectorXd& q) const {
    return arm_.ComputeSphereCenters(q, /*with_jacobian=*/false).p_WS.col(5);
  }

  const robot::RobotModel arm_ = MakePlanarArm();
  const BallField field_{{0.9, 0.4, 0}, {0, -0.3, 0}, 0.15};
};

TEST_P(EveryPlanner, AnswersOnTheRequestsGridWithFiniteNumbers) {
  const PlanResult result = Plan(Request());
  ASSERT_NO_THROW(CheckTrajectory(result.trajectory.value()));
  EXPECT_EQ(result.trajectory->num_joints(), 2);
  ASSERT_EQ(result.trajectory->num_states(), 21);
  for (int k = 0; k < 21; ++k) EXPECT_NEAR(result.trajectory->t_s(k), 0.1 * k, 1e-12);
  EXPECT_TRUE(std::isfinite(result.cost.total()));
  EXPECT_TRUE(std::isfinite(result.clearance.least_m));
}

TEST_P(EveryPlanner, StartsWhereItIsToldToTheBit) {
  const PlanRequest request = Request();
  const PlanResult result = Plan(request);
  EXPECT_EQ(result.trajectory->q.col(0), request.q_start);
  EXPECT_EQ(result.trajectory->v.col(0), request.v_start);
}

TEST_P(EveryPlanner, KeepsFixedStatesToTheBit) {
  const PlanRequest request = RequestWithFixedStates();
  const PlanResult result = Plan(request);
  EXPECT_EQ(result.trajectory->q.leftCols(8), request.initial->q.leftCols(8));
  EXPECT_EQ(result.trajectory->v.leftCols(8), request.initial->v.leftCols(8));
}

TEST_P(EveryPlanner, RestsThroughFixedStatesWithoutAGuess) {
  PlanRequest request = Request();
  request.v_start.setZero();
  request.num_fixed = 4;
  const PlanResult result = Plan(request);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(result.trajectory->q.col(k), request.q_start);
    EXPECT_EQ(result.trajectory->v.col(k), Eigen::Vector2d::Zero());
  }
}

TEST_P(EveryPlanner, RepeatsItselfBitForBit) {
  for (const PlanRequest& request : {Request(), RequestWithFixedStates()}) {
    const PlanResult first = Plan(request), second = Plan(request);
    EXPECT_EQ(first.trajectory->q, second.trajectory->q);
    EXPECT_EQ(first.trajectory->v, second.trajectory->v);
    EXPECT_EQ(first.iterations, second.iterations);
    EXPECT_EQ(first.cost.total(), second.cost.total());
    EXPECT_EQ(first.clearance.least_m, second.clearance.least_m);
  }
}

TEST_P(EveryPlanner, SaysOfItsPlanWhatIsTrueOfItInTheField) {
  // Balls that pass by, sit at the goal, and sit where the robot is and stays for the first step.
  const PlanRequest base = Request();
  const BallField at_goal(Tip(base.q_goal), {0, 0, 0}, 0.1);
  const BallField at_start(Tip(base.q_start), {0, 0, 0}, 0.3);
  for (const BallField* const field : {&field_, &at_goal, &at_start}) {
    for (PlanRequest request : {Request(), RequestWithFixedStates()}) {
      request.field = field;
      const PlanResult result = Plan(request);
      const auto time_of = [&](int k) {
        return request.start + HorizonOffset(result.trajectory->t_s(k));
      };
      const Clearance truth =
          MeasureClearance(arm_, *field, *result.trajectory, request.start,
                           time_of(request.num_fixed - 1), time_of(request.num_states - 1));
      EXPECT_EQ(result.clearance.least_m, truth.least_m);
      EXPECT_EQ(result.clearance.first_contact, truth.first_contact);
      EXPECT_EQ(result.status == PlanStatus::kInCollision, truth.first_contact.has_value());
      if (field == &at_start && request.num_fixed == 1) {
        EXPECT_EQ(result.status, PlanStatus::kInCollision);
      }
    }
  }
}

TEST_P(EveryPlanner, KeepsToItsBudget) {
  for (PlanRequest request : {Request(), RequestWithFixedStates()}) {
    for (const int iterations : {1, 2, 7}) {
      request.budget.iterations = iterations;
      EXPECT_LE(Plan(request).iterations, iterations);
    }
    request.budget.iterations = std::numeric_limits<int>::max();
    const int all = Plan(request).iterations;
    std::atomic<bool> stop = true;
    request.budget.stop = &stop;
    EXPECT_LE(Plan(request).iterations, std::min(all, 2));
    request.budget.stop = nullptr;
    request.budget.deadline = std::chrono::steady_clock::now();
    EXPECT_LE(Plan(request).iterations, std::min(all, 2));
  }
}

TEST_P(EveryPlanner, SaysSoWhenAFreePlanExceedsALimitThatItWasAskedToKeep) {
  const BallField nothing({100, 0, 0}, {0, 0, 0}, 0.1);
  PlanRequest request = Request();  // 2.3 rad in 2 s
  request.field = &nothing;
  PlannerSettings slow;
  slow.velocity_scale = 0.2;  // of 2 rad/s, which is 0.8 rad in 2 s
  const auto planner = MakePlanner(GetParam(), arm_, slow);
  const PlanResult plan = planner->Plan(request);
  const bool exceeds = plan.limit_use.velocity > slow.velocity_scale ||
                       plan.limit_use.acceleration > slow.acceleration_scale;
  EXPECT_EQ(ToString(plan.status) == "over_limits", exceeds);
  if (planner->capabilities().reaches_goal) {
    EXPECT_GT(plan.limit_use.velocity, 0.5);
  }
  slow.velocity_limits = false;
  slow.acceleration_scale = 1;
  EXPECT_EQ(MakePlanner(GetParam(), arm_, slow)->Plan(request).status, PlanStatus::kSolved);
}

TEST_P(EveryPlanner, RefusesSettingsOutOfRange) {
  const std::vector<std::function<void(PlannerSettings&)>> spoil = {
      [](PlannerSettings& s) { s.epsilon_m = -0.1; },
      [](PlannerSettings& s) { s.velocity_scale = 1.1; },
      [](PlannerSettings& s) { s.acceleration_scale = 0; },
  };
  for (std::size_t i = 0; i < spoil.size(); ++i) {
    PlannerSettings settings;
    spoil[i](settings);
    EXPECT_THROW(MakePlanner(GetParam(), arm_, settings), std::invalid_argument) << "setting " << i;
  }
}

TEST_P(EveryPlanner, TakesWhatItDeclaresAndNothingElse) {
  const std::vector<Parameter> declared = KindOfPlanner(GetParam()).parameters;
  const auto make = [&](const Parameters& given) {
    return MakePlanner(GetParam(), arm_, {}, given)->Plan(Request());
  };
  const PlanResult by_default = make({});
  Parameters defaults;
  for (const Parameter& parameter : declared) {
    EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
    EXPECT_NO_THROW(CheckValue(parameter, parameter.default_value)) << parameter.name;
    defaults[parameter.name] = ParseValue(parameter, ToText(parameter.default_value));
    const auto refuses = [&](const ParameterValue& value) {
      EXPECT_THROW(make({{parameter.name, value}}), std::invalid_argument) << parameter.name;
    };
    refuses(std::string("no word of it"));
    if (std::holds_alternative<double>(parameter.default_value)) {
      refuses(kNaN);
      if (std::isfinite(parameter.least)) refuses(parameter.least - 1);
      if (std::isfinite(parameter.most)) refuses(parameter.most * 1.01);
    }
    if (std::holds_alternative<int>(parameter.default_value)) {
      if (std::isfinite(parameter.least)) refuses(static_cast<int>(parameter.least) - 1);
      if (std::isfinite(parameter.most)) refuses(static_cast<int>(parameter.most) + 1);
    }
  }
  EXPECT_EQ(make(defaults).trajectory->q, by_default.trajectory->q);
  EXPECT_THROW(make({{"nonesuch", 1.0}}), std::invalid_argument);
}

TEST_P(EveryPlanner, RefusesRequestsThatMeanNothing) {
  const std::vector<std::function<void(PlanRequest&)>> spoil = {
      [](PlanRequest& r) { r.field = nullptr; },
      [](PlanRequest& r) { r.start = EpisodeTime(kNaN); },
      [](PlanRequest& r) { r.step_s = 0; },
      [](PlanRequest& r) { r.step_s = kNaN; },
      [](PlanRequest& r) { r.step_s = 1e-200; },
      [](PlanRequest& r) { r.num_states = 1; },
      [](PlanRequest& r) { r.q_start = Eigen::VectorXd::Zero(3); },
      [](PlanRequest& r) { r.q_start(1) = kNaN; },
      [](PlanRequest& r) { r.v_start.resize(0); },
      [](PlanRequest& r) { r.q_goal(0) = std::numeric_limits<double>::infinity(); },
      [](PlanRequest& r) { r.num_fixed = 0; },
      [](PlanRequest& r) { r.budget.iterations = 0; },
      [](PlanRequest& r) { r.num_fixed = 21; },
      [](PlanRequest& r) { r.v_start(0) += 1e-9; },  // is not where the fixed states begin
      [](PlanRequest& r) { r.initial.reset(); },     // fixed states at rest, but it moves
      [](PlanRequest& r) { r.initial->q(1, 15) = kNaN; },
      [](PlanRequest& r) { r.initial->t_s *= 1.01; },
      [](PlanRequest& r) { r.num_states = 20; },
      [](PlanRequest& r) { r.initial->q = Eigen::MatrixXd::Zero(3, 21); },
  };
  const auto planner = MakePlanner(GetParam(), arm_, {});
  ASSERT_NO_THROW(planner->Plan(RequestWithFixedStates()));
  for (std::size_t i = 0; i < spoil.size(); ++i) {
    PlanRequest request = RequestWithFixedStates();
    spoil[i](request);
    EXPECT_THROW(planner->Plan(request), std::invalid_argument) << "request " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Registered, EveryPlanner, ::testing::ValuesIn(PlannerNames()),
                         [](const auto& test) { return test.param; });

TEST_P(EveryPlanner, GetsAsManyIterationsForOneOfGpmpAsItSaysTakeNoMoreTime) {
  const auto planner = MakePlanner(GetParam(), MakePlanarArm(), {});
  const int for_one = planner->capabilities().iterations_for_one;
  EXPECT_GE(for_one, 1);
  if (GetParam() == "gpmp") {
    EXPECT_EQ(for_one, 1);
  }
  EXPECT_EQ(planner->BudgetOf(40).iterations, 40 * for_one);
  constexpr int kNoEnd = std::numeric_limits<int>::max();
  EXPECT_EQ(planner->BudgetOf(kNoEnd).iterations, kNoEnd);
}

std::vector<std::string> PlannersThatDeclare(bool PlannerCapabilities::*capability) {
  std::vector<std::string> names;
  for (const std::string& name : PlannerNames()) {
    if (MakePlanner(name, MakePlanarArm(), {})->capabilities().*capability) names.push_back(name);
  }
  return names;
}

class PlannerThatReachesTheGoal : public EveryPlanner {};

TEST_P(PlannerThatReachesTheGoal, EndsThereAtRest) {
  for (const PlanRequest& request : {Request(), RequestWithFixedStates()}) {
    const PlanResult result = Plan(request);
    EXPECT_LT((result.trajectory->q.col(20) - request.q_goal).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT(result.trajectory->v.col(20).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST_P(PlannerThatReachesTheGoal, ChoosesTheStatesThatAreNotFixed) {
  const PlanRequest request = RequestWithFixedStates();
  EXPECT_NE(Plan(request).trajectory->q.col(8), request.initial->q.col(8));
}

TEST_P(PlannerThatReachesTheGoal, CollidesWithWhatSitsOnItOrEndsElsewhereAndSaysSo) {
  for (PlanRequest request : {Request(), RequestWithFixedStates()}) {
    const BallField at_goal(Tip(request.q_goal), {0, 0, 0}, 0.1);
    request.field = &at_goal;
    const PlanResult result = Plan(request);
    const double off_rad = (result.trajectory->q.col(20) - request.q_goal).cwiseAbs().maxCoeff();
    if (result.clearance.first_contact) {
      EXPECT_EQ(result.status, PlanStatus::kInCollision);
    } else {
      EXPECT_GT(off_rad, 0.01);
      EXPECT_TRUE(result.status == PlanStatus::kShortOfGoal ||
                  result.status == PlanStatus::kOverLimits)
          << ToString(result.status);
      EXPECT_FALSE(result.reason.empty());
      EXPECT_LT(result.trajectory->v.col(20).cwiseAbs().maxCoeff(), 1e-3);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Declared, PlannerThatReachesTheGoal,
    ::testing::ValuesIn(PlannersThatDeclare(&PlannerCapabilities::reaches_goal)),
    [](const auto& test) { return test.param; });

class PlannerThatAvoidsObstacles : public EveryPlanner {};

TEST_P(PlannerThatAvoidsObstacles, IsFreeWhereTheDirectMotionIsNot) {
  // At the far end of the arm's way, where a bent elbow is enough.
  const BallField standing({1.05, 0, 0}, {0, 0, 0}, 0.1),
      passing({1.05, -0.2, 0}, {0, 0.2, 0}, 0.1);
  for (const BallField* const field : {&standing, &passing}) {
    PlanRequest request = Request();
    request.field = field;
    EXPECT_LT(MakePlanner("straight_line", arm_, {})->Plan(request).clearance.least_m, -0.05);
    EXPECT_GT(Plan(request).clearance.least_m, 0.05);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Declared, PlannerThatAvoidsObstacles,
    ::testing::ValuesIn(PlannersThatDeclare(&PlannerCapabilities::avoids_obstacles)),
    [](const auto& test) { return test.param; });

TEST(PlannerRegistry, NamesThePlannersThereAreWhenAskedForAnother) {
  try {
    MakePlanner("chomp", MakePlanarArm(), {});
    FAIL() << "was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "unknown planner 'chomp'; there are: gauss_newton, gpmp, gpmp_ceres, gpmp_fast, "
                 "straight_line, hold_still");
  }
}

}  // namespace
}  // namespace sidestep::planner
