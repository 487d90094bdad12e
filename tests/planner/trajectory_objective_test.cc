// The objective as one quadratic: against the least-squares problem that Ceres is given, and the
// solver of its normal equations against dense algebra.

#include "sidestep/planner/objective/trajectory_objective.h"

#include <ceres/crs_matrix.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/Cholesky>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/planner/compressed/chain_rows.h"
#include "sidestep/planner/compressed/compressed_problem.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/gp_problem.h"
#include "tests/sdf/only_target.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::trajectory_objective_test {
namespace {

struct Case {
  std::string name;
  bool is_panda;
  int num_fixed, num_interpolated;
  bool free_start, limits;
};
std::ostream& operator<<(std::ostream& stream, const Case& test) { return stream << test.name; }

class TrajectoryObjectiveOf : public ::testing::TestWithParam<Case> {
 protected:
  TrajectoryObjectiveOf()
      : robot_(GetParam().is_panda ? robot::RobotModel::FromFile(
                                         SIDESTEP_SOURCE_DIR "/models/panda/robot.yaml", Pose())
                                   : MakePlanarArm()),
        ball_({0.5, -0.3, GetParam().is_panda ? 0.4 : 0}, {0, 0.3, 0}, 0.2) {
    const int n = robot_.num_joints();
    request_.field = &ball_;
    request_.start = EpisodeTime(0.3);
    request_.step_s = 0.1;
    request_.num_states = 12;
    request_.num_fixed = GetParam().num_fixed;
    request_.q_start = Eigen::Vector2d(-1.1, 0.3);
    request_.q_goal = Eigen::Vector2d(1.2, -0.2);
    if (GetParam().is_panda) {
      request_.q_start = robot_.configurations().at("right_ready");
      request_.q_goal = robot_.configurations().at("table_forward");
    }
    request_.v_start = Eigen::VectorXd::Zero(n);
    options_.epsilon_m = 0.3;
    options_.num_interpolated = GetParam().num_interpolated;
    options_.self_epsilon_m = 0.05;
    options_.sigma_goal = 1e-2;
    if (GetParam().free_start) options_.sigma_fixed = 1e-2;
    // A rough motion, so that every kind of cost has something to say.
    RandomStream random(7, "motion");
    motion_ = MakeDirectMotion(request_, Timing::kWholeTime);
    for (int k = request_.num_fixed; k < request_.num_states; ++k) {
      for (int i = 0; i < n; ++i) {
        motion_.q(i, k) += 0.1 * random.Normal();
        motion_.v(i, k) += 0.3 * random.Normal();
      }
    }
  }

  SoftLimits Limits() const {
    return MakeSoftLimits(robot_, request_.q_start, request_.q_goal, {1000, 30, 5}, 0.4, 0.3);
  }

  // Cost, gradient and J^T J of Ceres' problem.
  struct Normal {
    double cost;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
    PlanCost parts;
  };
  Normal OfCeres() {
    GpProblem problem(robot_, request_, motion_, options_);
    if (GetParam().limits) problem.AddLimits(Limits());
    Normal normal = Evaluated(problem);
    normal.parts = problem.ComputeCost();
    return normal;
  }
  template <class Problem>
  Normal Evaluated(Problem& problem) {
    Normal normal;
    std::vector<double> gradient;
    ceres::CRSMatrix jacobian;
    ceres::Problem::EvaluateOptions free_states;
    for (int k = GetParam().free_start ? 0 : request_.num_fixed; k < request_.num_states; ++k) {
      free_states.parameter_blocks.push_back(const_cast<double*>(problem.states().col(k).data()));
    }
    problem.problem().Evaluate(free_states, &normal.cost, nullptr, &gradient, &jacobian);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(jacobian.num_rows, jacobian.num_cols);
    for (int row = 0; row < jacobian.num_rows; ++row) {
      for (int at = jacobian.rows[row]; at < jacobian.rows[row + 1]; ++at) {
        J(row, jacobian.cols[at]) = jacobian.values[at];
      }
    }
    normal.gradient = Eigen::Map<Eigen::VectorXd>(gradient.data(), J.cols());
    normal.hessian = J.transpose() * J;
    return normal;
  }

  TrajectoryObjective Objective() const {
    TrajectoryObjective objective(robot_, request_, motion_.t_s, options_);
    objective.Restart(motion_);
    if (GetParam().limits) objective.AddLimits(Limits());
    return objective;
  }
  Eigen::MatrixXd States() const {
    Eigen::MatrixXd states(2 * robot_.num_joints(), request_.num_states);
    states << motion_.q, motion_.v;
    return states;
  }
  ChainQuadratic Evaluate() {
    TrajectoryObjective objective = Objective();
    ChainQuadratic quadratic = objective.MakeQuadratic();
    objective.Evaluate(States(), quadratic);
    return quadratic;
  }

  robot::RobotModel robot_;
  BallField ball_;
  PlanRequest request_;
  GpProblemOptions options_;
  Trajectory motion_;
};

TEST_P(TrajectoryObjectiveOf, HasTheCostGradientAndHessianOfCeresProblem) {
  const Normal expected = OfCeres();
  const ChainQuadratic got = Evaluate();
  const auto expect = [](double value, double of_ceres) {
    EXPECT_NEAR(value, of_ceres, 1e-11 * (1 + of_ceres));
  };
  expect(got.cost.gp, expected.parts.gp);
  expect(got.cost.obstacle, expected.parts.obstacle);
  expect(got.cost.limits, expected.parts.limits);
  expect(got.cost.goal, expected.parts.goal);
  EXPECT_GT(got.cost.obstacle, 1);
  EXPECT_EQ(got.cost.limits > 1, GetParam().limits);
  EXPECT_LT((got.DenseGradient() - expected.gradient).norm(), 1e-11 * expected.gradient.norm());
  EXPECT_LT((got.DenseHessian() - expected.hessian).norm(), 1e-11 * expected.hessian.norm());
}

TEST_P(TrajectoryObjectiveOf, IsTheSameToCeresInFewAndSmallBlocks) {
  const Normal expected = OfCeres();
  TrajectoryObjective objective = Objective();
  CompressedProblem problem(objective, States());
  const Normal got = Evaluated(problem);
  EXPECT_NEAR(got.cost, expected.cost, 1e-11 * expected.cost);
  EXPECT_LT((got.gradient - expected.gradient).norm(), 1e-9 * expected.gradient.norm());
  EXPECT_LT((got.hessian - expected.hessian).norm(), 1e-9 * expected.hessian.norm());
  // Without a Jacobian too.
  double cost = 0;
  problem.problem().Evaluate({}, &cost, nullptr, nullptr, nullptr);
  EXPECT_NEAR(cost, expected.cost, 1e-11 * expected.cost);
  // No more rows than unknowns, but for the one that keeps what no step changes.
  EXPECT_EQ(problem.problem().NumResiduals(), problem.problem().NumParameters() + 1);
}

TEST_P(TrajectoryObjectiveOf, IsRowsThatSayWhatTheBestStepGains) {
  const ChainQuadratic quadratic = Evaluate();
  const int D = quadratic.block_size(), K = quadratic.num_blocks();
  ChainRows rows;
  ASSERT_TRUE(rows.Set(quadratic));
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(K * D, K * D);
  Eigen::VectorXd r(K * D), own(D), next(D);
  for (int k = 0; k < K; ++k) {
    for (int i = 0; i < D; ++i) {
      const int row = k * D + i;
      const bool is_last = k + 1 == K;
      rows.CopyRow(k, i, own.data(), is_last ? nullptr : next.data());
      R.row(row).segment(k * D, D) = own;
      if (!is_last) R.row(row).segment(row - i + D, D) = next;
      r(row) = rows.residual(k, i);
    }
  }
  const Eigen::MatrixXd H = quadratic.DenseHessian();
  const Eigen::VectorXd g = quadratic.DenseGradient();
  EXPECT_TRUE(R.isUpperTriangular());
  EXPECT_LT((R.transpose() * R - H).norm(), 1e-12 * H.norm());
  EXPECT_LT((R.transpose() * r - g).norm(), 1e-10 * g.norm());
  const double gain = 0.5 * g.dot(H.llt().solve(g)), cost = quadratic.cost.total();
  EXPECT_NEAR(rows.gain(), gain, 1e-7 * gain);
  EXPECT_NEAR(rows.gain() + rows.rest(), cost, 1e-12 * cost);
  EXPECT_GT(gain, 0.01 * cost) << "there is nothing to gain";

  ChainQuadratic saddle = quadratic;
  saddle.panel(0)[0] = -1;
  EXPECT_FALSE(rows.Set(saddle));
}

TEST_P(TrajectoryObjectiveOf, IsSolvedAsByDenseAlgebraAndToTheBitByAnyInstructionSet) {
  std::optional<sdf::AlignedVector<double>> first;
  for (const std::int64_t instructions : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(instructions));
    const sdf::OnlyTarget only(instructions);
    const ChainQuadratic quadratic = Evaluate();
    const int D = quadratic.block_size(), K = quadratic.num_blocks();
    sdf::AlignedVector<double> damping(quadratic.vector_size(), 0.0), step;
    Eigen::MatrixXd H = quadratic.DenseHessian();
    for (int k = 0; k < K; ++k) {
      for (int i = 0; i < D; ++i) {
        damping[static_cast<std::size_t>(k * quadratic.stride() + i)] = 0.5 + 0.1 * i;
        H(k * D + i, k * D + i) += 0.5 + 0.1 * i;
      }
    }
    ASSERT_TRUE(ChainSolver().Solve(quadratic, damping, step));
    const Eigen::VectorXd expected = H.llt().solve(-quadratic.DenseGradient());
    for (int k = 0; k < K; ++k) {
      for (int i = 0; i < D; ++i) {
        ASSERT_NEAR(step[static_cast<std::size_t>(k * quadratic.stride() + i)], expected(k * D + i),
                    1e-8 * expected.norm());
      }
    }
    if (!first) first = step;
    ASSERT_EQ(*first, step);
  }
}

TEST_P(TrajectoryObjectiveOf, IsNotSolvedUnlessItIsPositiveDefinite) {
  ChainQuadratic quadratic = Evaluate();
  quadratic.panel(3)[2 * (2 * quadratic.stride()) + 2] = -1;
  const sdf::AlignedVector<double> damping(quadratic.vector_size(), 0.5);
  sdf::AlignedVector<double> step;
  EXPECT_FALSE(ChainSolver().Solve(quadratic, damping, step));
}

INSTANTIATE_TEST_SUITE_P(Problems, TrajectoryObjectiveOf,
                         ::testing::Values(Case{"Panda", true, 1, 1, false, false},
                                           Case{"PandaWithLimits", true, 3, 1, false, true},
                                           Case{"PandaDense", true, 2, 19, false, false},
                                           Case{"PandaAtStatesAlone", true, 1, 0, false, true},
                                           Case{"PandaWithAFreeStart", true, 2, 2, true, true},
                                           Case{"TwoLinks", false, 1, 3, false, true},
                                           Case{"TwoLinksWithAFreeStart", false, 2, 1, true,
                                                false}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep::planner::trajectory_objective_test
