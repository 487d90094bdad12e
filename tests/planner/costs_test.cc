// Every cost function: its values against formulas, its Jacobian against differences.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/planner/costs/acceleration_limit_cost.h"
#include "sidestep/planner/costs/gp_prior_cost.h"
#include "sidestep/planner/costs/interpolated_obstacle_cost.h"
#include "sidestep/planner/costs/mid_velocity_limit_cost.h"
#include "sidestep/planner/costs/obstacle_cost.h"
#include "sidestep/planner/costs/state_limit_cost.h"
#include "sidestep/planner/costs/state_prior_cost.h"
#include "sidestep/planner/gp_trajectory.h"
#include "tests/support/ball_field.h"
#include "tests/support/jacobian_check.h"
#include "tests/support/planar_arm.h"

namespace sidestep::planner::costs_test {
namespace {

constexpr double kStep_s = 0.1;

Eigen::VectorXd Residuals(const ceres::CostFunction& cost,
                          const std::vector<Eigen::VectorXd>& blocks) {
  std::vector<const double*> pointers;
  for (const Eigen::VectorXd& block : blocks) pointers.push_back(block.data());
  Eigen::VectorXd residuals(cost.num_residuals());
  EXPECT_TRUE(cost.Evaluate(pointers.data(), residuals.data(), nullptr));
  return residuals;
}

// The arm beside a ball that passes in front of it, which the costs of a case may watch.
struct World {
  robot::RobotModel arm = MakePlanarArm();
  BallField field{{0.9, 0.3, 0}, {0, -0.3, 0.05}, 0.1};
  ObstacleHinge hinge{arm, field, /*epsilon_m=*/0.2, /*sigma=*/0.05};
};

struct Case {
  std::string name;
  std::function<std::unique_ptr<ceres::CostFunction>(World&)> make;
  std::vector<Eigen::VectorXd> blocks;  // states (q1, q2, v1, v2)
};
std::ostream& operator<<(std::ostream& stream, const Case& test) { return stream << test.name; }

std::unique_ptr<ceres::CostFunction> AtState(World& world, double t_s) {
  return std::make_unique<ObstacleCost>(world.hinge, EpisodeTime(t_s));
}
std::unique_ptr<ceres::CostFunction> Between(World& world, double t_s, double share) {
  return std::make_unique<InterpolatedObstacleCost>(
      world.hinge, InterpolateGp(kStep_s, share * kStep_s), EpisodeTime(t_s + share * kStep_s));
}
std::unique_ptr<ceres::CostFunction> Limit(World&) {
  return std::make_unique<StateLimitCost>(Eigen::Vector4d(-2.5, -2.5, -2, -2),
                                          Eigen::Vector4d(2.5, 2.5, 2, 2),
                                          Eigen::Vector4d(1000, 1000, 300, 300));
}
std::unique_ptr<ceres::CostFunction> Acceleration(World&) {
  return std::make_unique<AccelerationLimitCost>(kStep_s, Eigen::Vector2d(10, 4),
                                                 Eigen::Vector2d(100, 50));
}
std::unique_ptr<ceres::CostFunction> MidVelocity(World&) {
  return std::make_unique<MidVelocityLimitCost>(kStep_s, Eigen::Vector2d(0.5, 0.3),
                                                Eigen::Vector2d(100, 50));
}

// Costs of an arm folded so far that its links are within the margin of each other.
struct FoldedWorld {
  robot::RobotModel arm =
      robot::RobotModel::FromFile(SIDESTEP_SOURCE_DIR "/tests/support/folding_arm.yaml", Pose());
  BallField field{{100, 0, 0}, {0, 0, 0}, 0.1};
  ObstacleHinge hinge{arm, field, /*epsilon_m=*/0.2, /*sigma=*/0.05, /*self_epsilon_m=*/0.1};
};

std::vector<Case> Cases() {
  using Eigen::Vector4d;
  return {
      {"GpPrior",
       [](World&) { return std::make_unique<GpPriorCost>(2, kStep_s, 0.7); },
       {Vector4d(0.1, -0.4, 1.2, 0.3), Vector4d(0.3, -0.2, 0.2, 0.5)}},
      {"StatePrior",
       [](World&) {
         return std::make_unique<StatePriorCost>(Eigen::Vector2d(1, 2), Eigen::Vector2d::Zero(),
                                                 1e-2);
       },
       {Vector4d(0.1, -0.4, 1.2, 0.3)}},
      {"ObstacleInside", [](World& w) { return AtState(w, 0); }, {Vector4d(0.3, 0.05, 1, -1)}},
      {"ObstacleNear", [](World& w) { return AtState(w, 0); }, {Vector4d(0.1, 0.3, 1, -1)}},
      {"ObstacleBothLinks", [](World& w) { return AtState(w, 0.5); }, {Vector4d(-0.3, 0.6, 0, 0)}},
      {"ObstacleMovedAway", [](World& w) { return AtState(w, 2); }, {Vector4d(-0.3, 0.1, 1, -1)}},
      {"BetweenInside",
       [](World& w) { return Between(w, 0, 0.5); },
       {Vector4d(0.25, 0.05, 1, -1), Vector4d(0.3, 0.0, 0.5, -1)}},
      {"BetweenEarly",
       [](World& w) { return Between(w, 0.3, 0.05); },
       {Vector4d(0.15, 0.25, 1, -1), Vector4d(0.3, 0.1, 0.5, -1)}},
      {"BetweenLate",
       [](World& w) { return Between(w, 0.3, 0.95); },
       {Vector4d(0.15, 0.25, 1, -1), Vector4d(0.3, 0.1, 0.5, -1)}},
      {"PositionAbove", Limit, {Vector4d(2.7, 0, 0, 0)}},
      {"PositionBelow", Limit, {Vector4d(0, -2.51, 0, 0)}},
      {"VelocityBothWays", Limit, {Vector4d(0, 0, 2.4, -2.2)}},
      // Both ends of the interval too fast, in opposite senses.
      {"AccelerationBothEnds", Acceleration, {Vector4d(0, 0, 0, 0), Vector4d(0.05, -0.03, 0, 0.1)}},
      {"MidVelocityBothWays", MidVelocity, {Vector4d(0, 0, 0.1, 0), Vector4d(0.05, -0.03, 0, 0.1)}},
      {"MidVelocityOneJoint", MidVelocity, {Vector4d(0, 0, 0.1, 0), Vector4d(0.01, -0.03, 0, 0.1)}},
      {"AccelerationOneEnd", Acceleration, {Vector4d(0, 0, 0, 0), Vector4d(0.04, 0.001, 0.6, 0)}},
  };
}

class CostJacobian : public ::testing::TestWithParam<Case> {};

TEST_P(CostJacobian, MatchesDifferences) {
  World world;
  ExpectJacobianMatchesDifferences(*GetParam().make(world), GetParam().blocks);
}
INSTANTIATE_TEST_SUITE_P(Where, CostJacobian, ::testing::ValuesIn(Cases()),
                         [](const auto& test) { return test.param.name; });

TEST(GpPriorCost, HalfItsSquareIsTheGpCostOfTheInterval) {
  const double qc = 0.7;
  const Eigen::Vector4d x0(0.1, -0.4, 1.2, 0.3), x1(0.3, -0.2, 0.2, 0.5);
  Trajectory trajectory{Eigen::Vector2d(0, kStep_s), Eigen::MatrixXd(2, 2), Eigen::MatrixXd(2, 2)};
  trajectory.q << x0.head(2), x1.head(2);
  trajectory.v << x0.tail(2), x1.tail(2);
  const double cost = 0.5 * Residuals(GpPriorCost(2, kStep_s, qc), {x0, x1}).squaredNorm();
  EXPECT_NEAR(cost, ComputeGpCost(trajectory, qc), 1e-12 * cost);
}

TEST(ObstacleHinge, IsTheMarginThatIsMissingInUnitsOfSigma) {
  World world;
  const Eigen::Vector2d q(0.3, 0.05);
  const EpisodeTime t(0.1);
  world.hinge.Evaluate(q, t, false);
  const robot::SphereCenters centers = world.arm.ComputeSphereCenters(q, false);
  ASSERT_EQ(world.hinge.num_hinges(), 5) << "sphere 0 is mounted";
  int active = 0;
  for (int s = 0; s < 5; ++s) {
    const double distance_m = (centers.p_WS.col(s + 1) - world.field.CenterAt(t)).norm() - 0.1;
    const double missing_m = 0.2 + world.arm.sphere_radii_m()(s + 1) - distance_m;
    EXPECT_NEAR(world.hinge.hinges()(s), std::max(0.0, missing_m) / 0.05, 1e-12);
    active += missing_m > 0;
  }
  EXPECT_GT(active, 0);
  EXPECT_LT(active, 5) << "one must be idle";
}

TEST(ObstacleHinge, PushesLinksApartThatComeNearEachOther) {
  FoldedWorld world;
  const Eigen::Vector2d q(0.2, 2.85);
  const auto hinge_at = [&world](const Eigen::Vector2d& at) {
    world.hinge.Evaluate(at, EpisodeTime(0), /*with_jacobian=*/true);
    return world.hinge.hinges()(2);
  };
  const double step = 1e-6;
  const double slope =
      (hinge_at(q + Eigen::Vector2d(0, step)) - hinge_at(q - Eigen::Vector2d(0, step))) /
      (2 * step);
  const double distance_m = std::sqrt(0.25 + 0.16 - 2 * 0.5 * 0.4 * std::cos(M_PI - q(1)));
  EXPECT_NEAR(hinge_at(q), (0.1 - (distance_m - 0.13)) / 0.05, 1e-12);
  ASSERT_EQ(world.hinge.num_hinges(), 3) << "two spheres and a pair of links";
  EXPECT_GT(slope, 1) << "folding further costs more";
  EXPECT_NEAR(world.hinge.jacobian()(2, 1), slope, 1e-6 * slope);
  EXPECT_NEAR(world.hinge.jacobian()(2, 0), 0, 1e-12) << "the shoulder moves both";
}

// A cost of one configuration of the Panda, all of it within the margin of a ball.
struct PandaNearABall {
  robot::RobotModel panda =
      robot::RobotModel::FromFile(SIDESTEP_SOURCE_DIR "/models/panda/robot.yaml", Pose());
  BallField field{{0.4, 0.2, 0.5}, {0, 0, 0}, 0.1};
  Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);

  // (J^T J, J^T r) and r^T r, with the number of rows.
  struct Normal {
    Eigen::MatrixXd JtJ_Jtr;
    double squares;
    Eigen::Index num_rows;
  };
  Normal Make(double epsilon_m, bool condensed) {
    ObstacleHinge hinge(panda, field, epsilon_m, 0.05, /*self_epsilon_m=*/0.3, condensed);
    hinge.Evaluate(q, EpisodeTime(0), /*with_jacobian=*/true);
    const Eigen::MatrixXd J = hinge.residual_jacobian();
    Eigen::MatrixXd both(7, 8);
    both << J.transpose() * J, J.transpose() * hinge.residuals();
    return {both, hinge.residuals().squaredNorm(), hinge.residuals().size()};
  }
};

TEST(ObstacleHinge, CondensedHasTheSameCostGradientAndCurvatureInFewerRows) {
  PandaNearABall world;
  for (const double epsilon_m : {0.0, 0.05, 0.2, 2.0}) {
    SCOPED_TRACE(epsilon_m);
    const auto plain = world.Make(epsilon_m, false), condensed = world.Make(epsilon_m, true);
    EXPECT_EQ(condensed.num_rows, 8);
    EXPECT_GT(plain.num_rows, 2 * condensed.num_rows);
    EXPECT_GT(plain.squares, 0);
    EXPECT_NEAR(condensed.squares, plain.squares, 1e-12 * plain.squares);
    EXPECT_LE((condensed.JtJ_Jtr - plain.JtJ_Jtr).norm(), 1e-12 * plain.JtJ_Jtr.norm());
  }
}

TEST(ObstacleHinge, CondensedHasTheSameCostWithoutAJacobian) {
  PandaNearABall world;
  ObstacleHinge hinge(world.panda, world.field, 0.2, 0.05, 0.3, /*condensed=*/true);
  hinge.Evaluate(world.q, EpisodeTime(0), /*with_jacobian=*/false);
  const double squares = world.Make(0.2, false).squares;
  EXPECT_NEAR(hinge.residuals().squaredNorm(), squares, 1e-12 * squares);
}

TEST(ObstacleHinge, HasNoneForLinksWithoutAMargin) {
  FoldedWorld world;
  EXPECT_EQ(ObstacleHinge(world.arm, world.field, 0.2, 0.05).num_hinges(), 2);
}

TEST(ObstacleHinge, LeavesMountSpheresOut) {
  const robot::RobotModel arm = MakePlanarArm();
  const BallField at_base({0, 0, 0}, {0, 0, 0}, 0.02);
  ObstacleHinge hinge(arm, at_base, /*epsilon_m=*/0.05, /*sigma=*/1);
  hinge.Evaluate(Eigen::Vector2d(0.4, 0.2), EpisodeTime(0), true);
  EXPECT_EQ(hinge.hinges().maxCoeff(), 0);
}

TEST(StateLimitCost, CountsOnlyWhatIsBeyondTheBounds) {
  World world;
  const auto cost = Limit(world);
  EXPECT_EQ(Residuals(*cost, {Eigen::Vector4d(2.5, -2.5, 2, -2)}), Eigen::Vector4d::Zero());
  EXPECT_LT(
      (Residuals(*cost, {Eigen::Vector4d(2.6, -2.7, 1, -2.1)}) - Eigen::Vector4d(100, 200, 0, 30))
          .cwiseAbs()
          .maxCoeff(),
      1e-9);
}

TEST(AccelerationLimitCost, IsTheExcessOfTheCubicAtBothEnds) {
  const Trajectory trajectory{Eigen::Vector2d(0, kStep_s),
                              (Eigen::MatrixXd(2, 2) << 0, 0.05, 0, -0.03).finished(),
                              (Eigen::MatrixXd(2, 2) << 0, 0.2, 0, 0.1).finished()};
  World world;
  const Eigen::VectorXd residuals =
      Residuals(*Acceleration(world),
                {(Eigen::VectorXd(4) << trajectory.q.col(0), trajectory.v.col(0)).finished(),
                 (Eigen::VectorXd(4) << trajectory.q.col(1), trajectory.v.col(1)).finished()});
  const Eigen::Vector2d a_max(10, 4), weight(100, 50);
  const Eigen::VectorXd a0 = Sample(trajectory, HorizonOffset(0)).a;
  // The acceleration is linear: the end is twice the middle less the begin.
  const Eigen::VectorXd a1 = 2 * Sample(trajectory, HorizonOffset(kStep_s / 2)).a - a0;
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(std::abs(a0(i)), a_max(i));
    EXPECT_NEAR(residuals(i), weight(i) * (std::abs(a0(i)) - a_max(i)), 1e-9);
    EXPECT_NEAR(residuals(2 + i), weight(i) * std::max(0.0, std::abs(a1(i)) - a_max(i)), 1e-9);
  }
}

TEST(MidVelocityLimitCost, IsTheExcessOfTheCubicInTheMiddle) {
  const Trajectory trajectory{Eigen::Vector2d(0, kStep_s),
                              (Eigen::MatrixXd(2, 2) << 0, 0.05, 0, -0.03).finished(),
                              (Eigen::MatrixXd(2, 2) << 0.1, 0.2, 0, 0.1).finished()};
  World world;
  const Eigen::VectorXd residuals =
      Residuals(*MidVelocity(world),
                {(Eigen::VectorXd(4) << trajectory.q.col(0), trajectory.v.col(0)).finished(),
                 (Eigen::VectorXd(4) << trajectory.q.col(1), trajectory.v.col(1)).finished()});
  const Eigen::VectorXd v = Sample(trajectory, HorizonOffset(kStep_s / 2)).v;
  const Eigen::Vector2d v_max(0.5, 0.3), weight(100, 50);
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(std::abs(v(i)), v_max(i));
    EXPECT_NEAR(residuals(i), weight(i) * (std::abs(v(i)) - v_max(i)), 1e-9);
  }
}

}  // namespace
}  // namespace sidestep::planner::costs_test
