// The fast chain against the plain formulation (GpProblem) and against dense algebra.

#include "sidestep/planner/gauss_newton.h"

#include <ceres/crs_matrix.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "sidestep/planner/gauss_newton_band.h"
#include "sidestep/planner/gp_problem.h"
#include "tests/support/ball_field.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::gauss_newton_test {
namespace {

constexpr int kNumStates = 9;
constexpr double kStep_s = 0.1;
constexpr double kSigma = 1e-2;

TEST(BlockTridiagonal, SolvesAsDenseAlgebraDoes) {
  constexpr int kBlocks = 4, kSize = 3, kAll = kBlocks * kSize;
  BlockTridiagonal band(kBlocks, kSize);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kAll, kAll);
  for (int k = 0; k + 1 < kBlocks; ++k) {
    Eigen::MatrixXd root(2 * kSize, 2 * kSize);
    for (int i = 0; i < root.size(); ++i) root(i) = std::sin(3.7 * i + k);
    Eigen::MatrixXd H = root * root.transpose();
    H.diagonal().array() += 0.1;  // sines alone span two dimensions only
    band.AddPair(k, H);
    dense.block(k * kSize, k * kSize, 2 * kSize, 2 * kSize) += H;
  }
  band.AddToDiagonal(2, 0.5);
  dense.block(2 * kSize, 2 * kSize, kSize, kSize).diagonal().array() += 0.5;
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(kAll, -1, 2);
  Eigen::VectorXd x = b;
  ASSERT_TRUE(band.Solve(x));
  EXPECT_LT((dense * x - b).norm(), 1e-10 * b.norm());
}

TEST(BlockTridiagonal, RefusesAMatrixThatIsNotPositiveDefinite) {
  BlockTridiagonal band(2, 1);
  band.AddPair(0, (Eigen::Matrix2d() << 1, 2, 2, 1).finished());
  Eigen::VectorXd x = Eigen::Vector2d(1, 1);
  EXPECT_FALSE(band.Solve(x));
}

// A planar arm sweeps past a moving ball.
class GaussNewtonTest : public ::testing::Test {
 protected:
  GaussNewtonTest() {
    for (int k = 0; k < kNumStates; ++k) {
      initial_.t_s(k) = k * kStep_s;
      initial_.q.col(k) = Eigen::Vector2d(-0.6 + 0.15 * k, 0.4 - 0.05 * k * k / 8.0);
      initial_.v.col(k) = Eigen::Vector2d(1.2 + 0.1 * std::sin(k), -0.1 * k);
    }
  }

  GaussNewton MakeChain(const GaussNewtonOptions& options) const {
    GaussNewton chain(arm_, initial_, options);
    for (int k = 0; k < kNumStates; ++k) chain.SetField(k, ball_, start_);
    const Eigen::Vector2d rest(0, 0);
    chain.AddPrior(0, initial_.q.col(0), rest, kSigma);
    chain.AddPrior(kNumStates - 1, q_goal_, rest, kSigma);
    return chain;
  }

  // The same objective, plainly.
  PlanRequest Request() const {
    PlanRequest request;
    request.field = &ball_;
    request.start = start_;
    request.step_s = kStep_s;
    request.num_states = kNumStates;
    request.q_start = initial_.q.col(0);
    request.v_start = Eigen::Vector2d::Zero();
    request.q_goal = q_goal_;
    return request;
  }
  static GpProblemOptions Plain(const GaussNewtonOptions& options) {
    return {.epsilon_m = options.epsilon_m,
            .sigma_obs = options.sigma_obs,
            .num_interpolated = options.num_interpolated,
            .qc = options.qc,
            .sigma_goal = kSigma,
            .sigma_fixed = kSigma};
  }

  static GaussNewtonOptions Options() {
    GaussNewtonOptions options;
    options.sigma_obs = 0.1;
    options.num_interpolated = 3;
    options.qc = 0.7;
    return options;
  }

  const robot::RobotModel arm_ = MakePlanarArm();
  const BallField ball_{{0.9, 0.3, 0}, {0, -0.3, 0.05}, 0.1};
  const EpisodeTime start_{0.3};
  const Eigen::Vector2d q_goal_{0.9, -0.1};
  Trajectory initial_{Eigen::VectorXd(kNumStates), Eigen::MatrixXd(2, kNumStates),
                      Eigen::MatrixXd(2, kNumStates)};
};

TEST_F(GaussNewtonTest, CountsTheCostOfThePlainFormulation) {
  const PlanCost chain = MakeChain(Options()).ComputeCost();
  const PlanCost plain = GpProblem(arm_, Request(), initial_, Plain(Options())).ComputeCost();
  ASSERT_GT(plain.obstacle, 0);
  EXPECT_NEAR(chain.gp, plain.gp, 1e-12 * plain.gp);
  EXPECT_NEAR(chain.obstacle, plain.obstacle, 1e-12 * plain.obstacle);
  EXPECT_NEAR(chain.goal, plain.goal, 1e-12 * plain.goal);
}

TEST_F(GaussNewtonTest, TakesTheStepThatTheNormalEquationsOfThePlainFormulationGive) {
  GpProblem plain(arm_, Request(), initial_, Plain(Options()));
  std::vector<double> gradient;
  ceres::CRSMatrix sparse;
  ceres::Problem::EvaluateOptions evaluate;
  plain.problem().GetParameterBlocks(&evaluate.parameter_blocks);
  ASSERT_TRUE(plain.problem().Evaluate(evaluate, nullptr, nullptr, &gradient, &sparse));
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (int i = sparse.rows[row]; i < sparse.rows[row + 1]; ++i) {
      J(row, sparse.cols[i]) += sparse.values[i];
    }
  }
  const Eigen::VectorXd g = Eigen::Map<const Eigen::VectorXd>(
      gradient.data(), static_cast<Eigen::Index>(gradient.size()));
  const Eigen::VectorXd step = (J.transpose() * J).ldlt().solve(-g);

  GaussNewtonOptions options = Options();
  options.max_iterations = 1;
  GaussNewton chain = MakeChain(options);
  chain.Solve();
  const Trajectory found = chain.GetTrajectory();
  for (int k = 0; k < kNumStates; ++k) {
    // Parameter blocks come in the order in which they were added: that of the states.
    EXPECT_LT((found.q.col(k) - initial_.q.col(k) - step.segment(4 * k, 2)).norm(), 1e-8) << k;
    EXPECT_LT((found.v.col(k) - initial_.v.col(k) - step.segment(4 * k + 2, 2)).norm(), 1e-8) << k;
  }
  EXPECT_GT(step.norm(), 0.1);
}

TEST_F(GaussNewtonTest, FindsTheClosedFormWhereNothingIsInTheWay) {
  // From rest to rest in time T the GP cost is 6 |dq|^2 / (qc T^3); sigma of the ends tends to 0.
  GaussNewton chain(arm_, initial_, Options());
  const Eigen::Vector2d rest(0, 0), q_start = initial_.q.col(0);
  chain.AddPrior(0, q_start, rest, 1e-6);
  chain.AddPrior(kNumStates - 1, q_goal_, rest, 1e-6);
  chain.Solve();
  const double T = initial_.t_s(kNumStates - 1);
  const double expected = 6 * (q_goal_ - q_start).squaredNorm() / (Options().qc * T * T * T);
  EXPECT_NEAR(chain.ComputeCost().total(), expected, 1e-9 * expected);
}

TEST_F(GaussNewtonTest, EndsAtAStepThatRaisesTheObjectiveAndKeepsIt) {
  // A deep, stiff obstacle: full steps leap over it.
  GaussNewtonOptions options = Options();
  options.sigma_obs = 1e-3;
  GaussNewton chain = MakeChain(options);
  bool raised = false;
  for (int solve = 0; solve < 20 && !raised; ++solve) {
    const GaussNewtonSummary summary = chain.Solve();
    const auto& errors = summary.errors;
    for (std::size_t i = 1; i + 1 < errors.size(); ++i) {
      EXPECT_LT(errors[i], errors[i - 1]) << "only the last step may raise it";
    }
    ASSERT_GE(errors.size(), 2u);
    raised = errors.back() > errors[errors.size() - 2];
    EXPECT_EQ(chain.ComputeCost().total(), errors.back());
  }
  EXPECT_TRUE(raised);
}

TEST_F(GaussNewtonTest, SeesANewFieldFromTheStepOnThatGetsIt) {
  GaussNewton chain = MakeChain(Options());
  const double before = chain.ComputeCost().obstacle;
  const BallField far({50, 0, 0}, {0, 0, 0}, 0.1);
  for (int k = 0; k < kNumStates; ++k) chain.SetField(k, far, start_);
  EXPECT_EQ(chain.ComputeCost().obstacle, 0);
  for (int k = 0; k < kNumStates; ++k) chain.SetField(k, ball_, start_);
  EXPECT_EQ(chain.ComputeCost().obstacle, before);
}

TEST_F(GaussNewtonTest, RefusesWhatDoesNotFit) {
  Trajectory short_one = initial_;
  short_one.t_s.conservativeResize(1);
  short_one.q.conservativeResize(2, 1);
  short_one.v.conservativeResize(2, 1);
  EXPECT_THROW(GaussNewton(arm_, short_one, {}), std::invalid_argument);
  GaussNewtonOptions no_sigma;
  no_sigma.sigma_obs = 0;
  EXPECT_THROW(GaussNewton(arm_, initial_, no_sigma), std::invalid_argument);
  GaussNewton chain(arm_, initial_, {});
  EXPECT_THROW(chain.AddPrior(kNumStates, q_goal_, q_goal_, 1), std::invalid_argument);
  EXPECT_THROW(chain.AddPrior(0, Eigen::VectorXd::Zero(3), q_goal_, 1), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::planner::gauss_newton_test
