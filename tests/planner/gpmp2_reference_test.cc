// A published planning problem, evaluated and solved by GPMP2 on GTSAM (bench/planner_bench/
// gpmp2_reference.h): every term of our objective has its value, and our solutions are no worse.

#include "sidestep/bench/planner_bench/gpmp2_reference.h"

#include <ceres/solver.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>

#include "sidestep/planner/fast/levenberg_marquardt.h"
#include "sidestep/planner/gp_problem.h"
#include "sidestep/planner/objective/trajectory_objective.h"
#include "sidestep/planner/planner.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner::gpmp2_reference_test {
namespace {

using bench::gpmp2_reference::kNumStates;
using bench::gpmp2_reference::kStep_s;

// The two objectives of the reference: many weak obstacle costs, and few stiff ones. Start and goal
// are both held by priors.
GpProblemOptions Dense() {
  return {.epsilon_m = 0.2, .sigma_obs = 0.2, .num_interpolated = 19, .sigma_fixed = 1e-4};
}
GpProblemOptions Sparse() {
  return {.epsilon_m = 0.3, .sigma_obs = 0.05, .num_interpolated = 1, .sigma_fixed = 1e-4};
}

class Gpmp2Reference : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    field_ = std::make_unique<bench::gpmp2_reference::SteppedField>();
  }
  static void TearDownTestSuite() { field_.reset(); }

  static robot::RobotModel MakeWam() {
    return robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "wam", Pose());
  }

  static PlanRequest Request() {
    PlanRequest request;
    request.field = field_.get();
    request.step_s = kStep_s;
    request.num_states = kNumStates;
    request.q_start = wam_.configurations().at("pose1");
    request.v_start = Eigen::VectorXd::Zero(7);
    request.q_goal = wam_.configurations().at("pose3");
    return request;
  }

  // GPMP2's initArmTrajStraightLine, whose velocities are per state and not per second, also at
  // start and goal.
  static Trajectory StraightLine() {
    const PlanRequest request = Request();
    Trajectory line{Eigen::VectorXd::LinSpaced(kNumStates, 0, (kNumStates - 1) * kStep_s),
                    Eigen::MatrixXd(7, kNumStates), Eigen::MatrixXd(7, kNumStates)};
    for (int k = 0; k < kNumStates; ++k) {
      line.q.col(k) = request.q_start + k / 30.0 * (request.q_goal - request.q_start);
      line.v.col(k) = (request.q_goal - request.q_start) / 30;
    }
    return line;
  }

  static Trajectory ReadTrajectory(const std::string& file) {
    std::ifstream stream(SIDESTEP_SOURCE_DIR "/tests/data/gpmp2_reference/" + file);
    EXPECT_TRUE(stream.good()) << file;
    Trajectory trajectory = StraightLine();
    std::string line;
    int k = 0;
    while (std::getline(stream, line)) {
      if (line.empty() || line[0] == '#' || line[0] == 'i') continue;
      std::istringstream row(line);
      std::string value;
      std::getline(row, value, ',');
      EXPECT_EQ(value, std::to_string(k));
      for (int i = 0; i < 14 && std::getline(row, value, ','); ++i) {
        (i < 7 ? trajectory.q(i, k) : trajectory.v(i - 7, k)) = std::stod(value);
      }
      ++k;
    }
    EXPECT_EQ(k, kNumStates);
    return trajectory;
  }

  static PlanCost CostOf(const Trajectory& trajectory, const GpProblemOptions& options) {
    return GpProblem(wam_, Request(), trajectory, options).ComputeCost();
  }

  // Every term at `trajectory`, to 1e-6 of itself. GTSAM's `published` has obstacle costs at
  // support states and between them apart, and start and goal priors together.
  struct Published {
    double total, gp, obstacle_at_states, obstacle_between;
  };
  static void ExpectTerms(const Trajectory& trajectory, const GpProblemOptions& options,
                          const Published& published) {
    GpProblemOptions at_states = options;
    at_states.num_interpolated = 0;
    const PlanCost cost = CostOf(trajectory, options);
    const double obstacle_at_states = CostOf(trajectory, at_states).obstacle;
    const auto expect = [](double value, double expected) {
      EXPECT_NEAR(value, expected, 1e-6 * expected);
    };
    expect(cost.gp, published.gp);
    expect(obstacle_at_states, published.obstacle_at_states);
    expect(cost.obstacle - obstacle_at_states, published.obstacle_between);
    expect(cost.total(), published.total);
    // What the published terms leave for the priors has nine decimals.
    EXPECT_NEAR(
        cost.goal,
        published.total - published.gp - published.obstacle_at_states - published.obstacle_between,
        1e-6 * cost.goal + 2e-9);
    EXPECT_EQ(cost.limits, 0);
  }

  // Our assembly, solved from the straight line to where it no longer improves.
  static PlanCost SolveFromStraightLine(const GpProblemOptions& objective) {
    GpProblem problem(wam_, Request(), StraightLine(), objective);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.max_num_iterations = 500;
    options.function_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem.problem(), &summary);
    EXPECT_EQ(summary.termination_type, ceres::CONVERGENCE) << summary.message;
    const PlanCost cost = problem.ComputeCost();
    EXPECT_NEAR(cost.total(), summary.final_cost, 1e-9 * cost.total());
    ::testing::Test::RecordProperty("cost", std::to_string(cost.total()));
    ::testing::Test::RecordProperty("iterations", static_cast<int>(summary.iterations.size()));
    return cost;
  }

  // The same by our own solver.
  static double SolveFastFromStraightLine(const GpProblemOptions& options) {
    const PlanRequest request = Request();
    const Trajectory line = StraightLine();
    TrajectoryObjective objective(wam_, request, line.t_s, options);
    objective.Restart(line);
    Eigen::MatrixXd states(14, kNumStates);
    states << line.q, line.v;
    LevenbergMarquardt solver(objective, LevenbergMarquardt::Ending::kLikeCeres);
    solver.Solve(200, 1e-12, states);  // to where only the kinks of the field are left
    const double cost = solver.cost().total();
    EXPECT_NEAR(CostOf({line.t_s, states.topRows(7), states.bottomRows(7)}, options).total(), cost,
                1e-9 * cost);
    return cost;
  }

  inline static const robot::RobotModel wam_ = MakeWam();
  inline static std::unique_ptr<bench::gpmp2_reference::SteppedField> field_;
};

TEST_F(Gpmp2Reference, ForwardKinematicsAtTheStartAgree) {
  const robot::SphereCenters centers =
      wam_.ComputeSphereCenters(wam_.configurations().at("pose1"), /*with_jacobian=*/false);
  const Eigen::Vector3d sphere_5(-0.347511658501, 0.422246388756, -0.073950215608);
  const Eigen::Vector3d sphere_13(-0.284257216582, 0.939785131234, -0.128106861879);
  EXPECT_LT((centers.p_WS.col(5) - sphere_5).norm(), 1e-11);
  EXPECT_LT((centers.p_WS.col(13) - sphere_13).norm(), 1e-11);
}

TEST_F(Gpmp2Reference, TermsOfTheDenseObjectiveAgreeAtTheStraightLine) {
  ExpectTerms(StraightLine(), Dense(),
              {1412678.898455001, 2055.580578000, 41.142012594, 718.953642185});
}

TEST_F(Gpmp2Reference, TermsOfTheDenseObjectiveAgreeAtItsOptimum) {
  ExpectTerms(ReadTrajectory("n19_lm_tight.csv"), Dense(),
              {91.335371006, 27.770110530, 5.102672730, 58.459981923});
}

TEST_F(Gpmp2Reference, TermsOfTheSparseObjectiveAgreeAtTheStraightLine) {
  ExpectTerms(StraightLine(), Sparse(),
              {1415708.239148923, 2055.580578000, 1972.218013369, 1817.218335332});
}

TEST_F(Gpmp2Reference, TermsOfTheSparseObjectiveAgreeAtItsOptimum) {
  ExpectTerms(ReadTrajectory("n1_lm_tight.csv"), Sparse(),
              {657.075759139, 133.511124005, 314.879252775, 208.657457793});
}

TEST_F(Gpmp2Reference, SolutionOfTheDenseObjectiveIsNoWorse) {
  EXPECT_LE(SolveFromStraightLine(Dense()).total(), 91.335371006 * (1 + 1e-6));
}

// It has at least two minima: GTSAM ended at 657.0758 by Levenberg-Marquardt and at 649.2093 by
// Dogleg.
TEST_F(Gpmp2Reference, SolutionOfTheSparseObjectiveIsNoWorse) {
  EXPECT_LE(SolveFromStraightLine(Sparse()).total(), 657.075759139 * (1 + 1e-6));
}

TEST_F(Gpmp2Reference, FastSolutionsAreNoWorse) {
  EXPECT_LE(SolveFastFromStraightLine(Dense()), 91.335371006 * (1 + 1e-6));
  EXPECT_LE(SolveFastFromStraightLine(Sparse()), 657.075759139 * (1 + 1e-6));
}

}  // namespace
}  // namespace sidestep::planner::gpmp2_reference_test
