// The faster back ends against their oracle, Ceres with one residual block a configuration: the
// same iterations to the same cost, whatever the problem.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/core/shape.h"
#include "sidestep/planner/ceres_solve.h"
#include "sidestep/planner/fast/levenberg_marquardt.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/gp_problem.h"
#include "sidestep/planner/objective/trajectory_objective.h"
#include "sidestep/planner/registry.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"
#include "tests/sdf/only_target.h"
#include "tests/support/ball_field.h"

namespace sidestep::planner {
namespace {

constexpr double kClamp_m = 0.35;

// A table, blocks on it at random, and a box that comes along.
sdf::CompositeField Room(std::uint64_t seed) {
  RandomStream random(seed, "room");
  OccupancyGrid grid({Eigen::Vector3d(-1.2, -1.2, -0.4), 0.04, {60, 60, 50}});
  for (int block = 0; block < 6; ++block) {
    const Eigen::Vector3d p(random.Uniform(0.3, 0.8), random.Uniform(-0.7, 0.7),
                            random.Uniform(0, 0.6));
    for (int k = 0; k < grid.spec.size[2]; ++k) {
      for (int j = 0; j < grid.spec.size[1]; ++j) {
        for (int i = 0; i < grid.spec.size[0]; ++i) {
          const Eigen::Vector3d apart = (grid.spec.Center(i, j, k) - p).cwiseAbs();
          if (apart.maxCoeff() < 0.06) grid.cells[grid.spec.Index(i, j, k)] = 1;
        }
      }
    }
  }
  const auto shape = std::make_shared<const sdf::SdfGrid>(
      sdf::MakeShapeField(Box{{0.25, 0.25, 1}}, 0.04, kClamp_m));
  const double speed = random.Uniform(0.4, 1.2);
  return sdf::CompositeField(std::make_shared<const sdf::SdfGrid>(sdf::ComputeSignedDistance(grid)),
                             {{shape,
                               [speed](EpisodeTime t) {
                                 return Pose::Translation({0.55, speed * (t.seconds() - 1.5), 0.3});
                               }}},
                             kClamp_m, StaticSolids{{}, {{{0, 0, 1}, -0.05}}});
}

robot::RobotModel Panda() {
  return robot::RobotModel::FromFile(SIDESTEP_SOURCE_DIR "/models/panda/robot.yaml", Pose());
}

PlanRequest Request(const robot::RobotModel& robot, const sdf::DistanceField& field,
                    std::uint64_t seed) {
  RandomStream random(seed, "request");
  PlanRequest request;
  request.field = &field;
  request.step_s = 0.1;
  request.num_states = 31;
  request.num_fixed = 1 + static_cast<int>(random.Bits() % 3);
  request.q_start = robot.configurations().at("right_ready");
  request.q_goal = robot.configurations().at("pickup_left");
  for (int i = 0; i < 7; ++i) {
    request.q_start(i) += random.Uniform(-0.2, 0.2);
    request.q_goal(i) += random.Uniform(-0.2, 0.2);
  }
  request.v_start = Eigen::VectorXd::Zero(7);
  return request;
}

// One solve by Ceres, and by ours to the rules of Ceres, with limits and without.
TEST(LevenbergMarquardt, TakesTheIterationsOfCeresToTheSameCost) {
  const robot::RobotModel panda = Panda();
  int num_same = 0, num_all = 0;
  for (const int num_interpolated : {0, 1, 4}) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", n_int " << num_interpolated);
      const auto field = Room(seed);
      const PlanRequest request = Request(panda, field, seed);
      const PlannerSettings settings;
      GpSettings gp;
      gp.num_interpolated = num_interpolated;
      const GpProblemOptions options = ObjectiveOf(settings, gp);
      const Trajectory guess = MakeDirectMotion(request, Timing::kWholeTime);
      GpProblem problem(panda, request, guess, options);
      TrajectoryObjective objective(panda, request, guess.t_s, options);
      objective.Restart(guess);
      if (seed % 2 == 0) {
        const SoftLimits limits = SoftLimitsOf(panda, request.q_start, request.q_goal, settings, 1);
        problem.AddLimits(limits);
        objective.AddLimits(limits);
      }
      const SolveOutcome expected = SolveByLevenbergMarquardt(problem.problem(), 40, 1e-4);
      LevenbergMarquardt solver(objective, LevenbergMarquardt::Ending::kLikeCeres);
      Eigen::MatrixXd states(14, request.num_states);
      states << guess.q, guess.v;
      const SolveOutcome got = solver.Solve(40, 1e-4, states);
      ++num_all;
      // Where a field's gradient jumps, a bit may decide which way a search goes; seldom.
      if (got.iterations != expected.iterations) continue;
      ++num_same;
      EXPECT_EQ(got.converged, expected.converged);
      const double cost = problem.ComputeCost().total();
      EXPECT_NEAR(solver.cost().total(), cost, 1e-7 * cost);
      EXPECT_LT((states - problem.states()).cwiseAbs().maxCoeff(), 1e-5);
    }
  }
  EXPECT_GE(num_same, num_all - 2);
}

TEST(LevenbergMarquardt, EndsSoonerAtNoHigherCost) {
  const robot::RobotModel panda = Panda();
  int num_converged = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto field = Room(seed);
    const PlanRequest request = Request(panda, field, seed);
    const Trajectory guess = MakeDirectMotion(request, Timing::kWholeTime);
    TrajectoryObjective objective(panda, request, guess.t_s, ObjectiveOf({}, {}));
    objective.Restart(guess);
    LevenbergMarquardt sooner(objective, LevenbergMarquardt::Ending::kSooner),
        like_ceres(objective, LevenbergMarquardt::Ending::kLikeCeres);
    Eigen::MatrixXd states(14, request.num_states);
    states << guess.q, guess.v;
    Eigen::MatrixXd states_of_ceres = states;
    const SolveOutcome expected = like_ceres.Solve(60, 1e-4, states_of_ceres);
    const SolveOutcome got = sooner.Solve(60, 1e-4, states);
    EXPECT_LE(got.iterations, expected.iterations);
    if (!expected.converged) continue;
    ++num_converged;
    EXPECT_TRUE(got.converged);
    EXPECT_NEAR(sooner.cost().total(), like_ceres.cost().total(), 2e-4 * like_ceres.cost().total());
    const double cost = sooner.cost().total();
    EXPECT_LE(sooner.Solve(60, 1e-4, states).iterations, 1) << "it ended where more was to be had";
    EXPECT_LE(sooner.cost().total(), cost);
  }
  EXPECT_GE(num_converged, 8);
}

TEST(SmoothnessBound, IsNeverLessThanWhatAStepCanGain) {
  const robot::RobotModel panda = Panda();
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto field = Room(seed);
    const PlanRequest request = Request(panda, field, seed);
    const Trajectory guess = MakeDirectMotion(request, Timing::kWholeTime);
    GpProblemOptions options = ObjectiveOf({}, {});
    if (seed % 2 == 0) options.sigma_fixed = 1e-3;
    Eigen::MatrixXd states(14, request.num_states);
    states << guess.q, guess.v;
    TrajectoryObjective objective(panda, request, guess.t_s, options);
    objective.Restart(guess);
    ChainQuadratic quadratic = objective.MakeQuadratic();
    objective.Evaluate(states, quadratic);
    const Eigen::VectorXd g = quadratic.DenseGradient();
    const double gain = 0.5 * g.dot(quadratic.DenseHessian().llt().solve(g));
    EXPECT_GE(objective.MostDecrease(quadratic), gain);
    // Where nothing but the priors counts, it is what a step gains.
    const BallField nothing({100, 0, 0}, {0, 0, 0}, 0.1);
    PlanRequest free = request;
    free.field = &nothing;
    options.self_epsilon_m.reset();
    TrajectoryObjective smooth(panda, free, guess.t_s, options);
    smooth.Restart(guess);
    states += 0.01 * Eigen::MatrixXd::NullaryExpr(14, request.num_states, [](auto i, auto k) {
                return std::sin(static_cast<double>(3 * i + 7 * k));
              });
    smooth.Evaluate(states, quadratic);
    const Eigen::VectorXd g0 = quadratic.DenseGradient();
    const double gain0 = 0.5 * g0.dot(quadratic.DenseHessian().llt().solve(g0));
    EXPECT_NEAR(smooth.MostDecrease(quadratic), gain0, 1e-8 * gain0);
  }
}

class FasterPlanner : public ::testing::TestWithParam<std::string> {};

TEST_P(FasterPlanner, FindsWhatItsOracleFinds) {
  const robot::RobotModel panda = Panda();
  const auto oracle = MakePlanner("gpmp", panda, {});
  const auto fast = MakePlanner(GetParam(), panda, {});
  int num_same = 0;
  constexpr int kNum = 16;
  for (std::uint64_t seed = 1; seed <= kNum; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto field = Room(seed);
    PlanRequest request = Request(panda, field, seed);
    const PlanResult expected = oracle->Plan(request), got = fast->Plan(request);
    const double cost = expected.cost.total();
    num_same += got.status == expected.status && std::abs(got.cost.total() - cost) < 1e-3 * cost;
    request.initial = expected.trajectory;
    const PlanResult warm_expected = oracle->Plan(request), warm_got = fast->Plan(request);
    EXPECT_EQ(warm_got.status, warm_expected.status);
    EXPECT_LE(warm_got.cost.total(), warm_expected.cost.total() * (1 + 3e-4));
  }
  EXPECT_GE(num_same, kNum - 2);
}

TEST_P(FasterPlanner, GivesTheSameBitsByAnyInstructionSet) {
  const robot::RobotModel panda = Panda();
  const auto planner = MakePlanner(GetParam(), panda, {});
  const auto field = Room(3);
  const PlanRequest request = Request(panda, field, 3);
  std::optional<PlanResult> first;
  for (const std::int64_t instructions : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(instructions));
    const sdf::OnlyTarget only(instructions);
    const PlanResult plan = planner->Plan(request);
    if (!first) first = plan;
    EXPECT_EQ(plan.trajectory->q, first->trajectory->q);
    EXPECT_EQ(plan.trajectory->v, first->trajectory->v);
    EXPECT_EQ(plan.cost.total(), first->cost.total());
  }
}

INSTANTIATE_TEST_SUITE_P(BackEnds, FasterPlanner, ::testing::Values("gpmp_ceres", "gpmp_fast"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace sidestep::planner
