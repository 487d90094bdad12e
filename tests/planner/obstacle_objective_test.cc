#include "sidestep/planner/objective/obstacle_objective.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/core/shape.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"
#include "tests/sdf/only_target.h"
#include "tests/support/ball_field.h"
#include "tests/support/random_points.h"

namespace sidestep::planner::obstacle_objective_test {
namespace {

constexpr double kClamp_m = 0.35;

// Boxes all around, and one that moves.
std::unique_ptr<sdf::CompositeField> Room() {
  OccupancyGrid grid({Eigen::Vector3d::Constant(-1), 0.05, {41, 41, 41}});
  RandomStream random(1, "cells");
  for (auto& cell : grid.cells) cell = random.Uniform() < 0.002 ? 1 : 0;
  const auto shape =
      std::make_shared<const sdf::SdfGrid>(sdf::MakeShapeField(Box{{0.2, 0.3, 1}}, 0.05, kClamp_m));
  return std::make_unique<sdf::CompositeField>(
      std::make_shared<const sdf::SdfGrid>(sdf::ComputeSignedDistance(grid)),
      std::vector<sdf::MovingField>{
          {shape,
           [](EpisodeTime t) {
             return Pose::FromRollPitchYaw({0, 0.2, t.seconds()}, {0.4, t.seconds() - 1, 0.4});
           }}},
      kClamp_m, StaticSolids{{}, {{{0, 0, 1}, -0.05}}});
}

struct Case {
  std::string name, robot;
  double epsilon_m;
  std::optional<double> self_epsilon_m;
};
std::ostream& operator<<(std::ostream& stream, const Case& test) { return stream << test.name; }

class ObstacleObjectiveOf : public ::testing::TestWithParam<Case> {
 protected:
  // Turned and lifted, so that the base's pose counts.
  static robot::RobotModel Robot() {
    return robot::RobotModel::FromFile(SIDESTEP_SOURCE_DIR + std::string("/") + GetParam().robot,
                                       Pose::FromRollPitchYaw({0.1, -0.2, 0.7}, {0.1, 0, 0.2}));
  }
  static constexpr double kSigma = 0.05;
  static ObstacleObjective Objective(const robot::RobotModel& robot) {
    return ObstacleObjective(
        MakeArm(robot, GetParam().epsilon_m, kSigma, GetParam().self_epsilon_m));
  }

  // All over the joints' range, and three turns beyond; of slides within their range.
  static Eigen::MatrixXd Configurations(const robot::RobotModel& robot, int count) {
    RandomStream random(3, "configurations");
    Eigen::MatrixXd q(robot.num_joints(), count);
    for (int c = 0; c < count; ++c) {
      for (int j = 0; j < q.rows(); ++j) {
        const auto joint =
            static_cast<std::size_t>(robot.moving_joints()[static_cast<std::size_t>(j)]);
        if (robot.joints()[joint].kind == robot::JointKind::kPrismatic) {
          const robot::JointLimits& limits = robot.limits()[static_cast<std::size_t>(j)];
          q(j, c) = random.Uniform(limits.q_min, limits.q_max);
        } else {
          q(j, c) = random.Uniform(-3, 3) + (c % 7 == 3 ? 6 * M_PI : 0);
        }
      }
    }
    return q;
  }

  struct Slices {
    Slices(const sdf::DistanceField& field, int count) {
      for (int c = 0; c < count; ++c) {
        times.emplace_back(0.03 * c);
        owned.push_back(field.At(times.back()));
        all.push_back(owned.back().get());
      }
    }
    std::vector<EpisodeTime> times;
    std::vector<std::unique_ptr<const sdf::FieldSlice>> owned;
    std::vector<const sdf::FieldSlice*> all;
  };
};

TEST_P(ObstacleObjectiveOf, AgreesWithTheCostsThemselves) {
  const robot::RobotModel robot = Robot();
  const auto field = Room();
  for (const int count : {1, 7, 8, 61}) {
    const Eigen::MatrixXd q = Configurations(robot, count);
    const Slices slices(*field, count);
    ObstacleQuadratics quadratics(robot.num_joints(), count);
    Objective(robot).Evaluate(q, slices.all, quadratics);
    int num_active = 0;
    for (int c = 0; c < count; ++c) {
      const ObstacleQuadratic expected =
          ReferenceQuadratic(robot, *field, GetParam().epsilon_m, kSigma, GetParam().self_epsilon_m,
                             q.col(c), slices.times[static_cast<std::size_t>(c)]);
      const ObstacleQuadratic got = quadratics.Get(c);
      ASSERT_NEAR(got.cost, expected.cost, 1e-11 * (1 + expected.cost));
      if (expected.cost == 0) continue;
      ++num_active;
      ASSERT_LT((got.gradient - expected.gradient).norm(), 1e-11 * (1 + expected.gradient.norm()));
      ASSERT_LT((got.hessian - expected.hessian).norm(), 1e-11 * (1 + expected.hessian.norm()));
    }
    EXPECT_GT(num_active, count / 2);
  }
}

TEST_P(ObstacleObjectiveOf, GivesTheSameBitsByAnyInstructionSetAndInAnyCompany) {
  const robot::RobotModel robot = Robot();
  const auto field = Room();
  constexpr int kCount = 21;
  const Eigen::MatrixXd q = Configurations(robot, kCount);
  const Slices slices(*field, kCount);
  ObstacleQuadratics first(robot.num_joints(), kCount);
  Objective(robot).Evaluate(q, slices.all, first);
  for (const std::int64_t instructions : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(instructions));
    const sdf::OnlyTarget only(instructions);
    ObstacleObjective objective = Objective(robot);
    for (const int begin : {0, 5}) {
      const int size = kCount - begin;
      ObstacleQuadratics again(robot.num_joints(), size);
      objective.Evaluate(
          q.rightCols(size),
          std::vector<const sdf::FieldSlice*>(slices.all.begin() + begin, slices.all.end()), again);
      for (int c = 0; c < size; ++c) {
        ASSERT_EQ(again.cost(c), first.cost(begin + c));
        ASSERT_EQ(again.Get(c).gradient, first.Get(begin + c).gradient);
        ASSERT_EQ(again.Get(c).hessian, first.Get(begin + c).hessian);
      }
    }
  }
}

// Against a field that is smooth, unlike one of cells.
TEST_P(ObstacleObjectiveOf, HasTheGradientThatDifferencesOfItsCostShow) {
  const robot::RobotModel robot = Robot();
  const BallField ball({0.3, 0.2, 0.5}, {0, 0, 0}, 0.2);
  const auto slice = ball.At(EpisodeTime(0));
  ObstacleObjective objective = Objective(robot);
  const int n = robot.num_joints();
  const Eigen::MatrixXd all = Configurations(robot, 20);
  constexpr double kStep = 1e-5;
  for (int c = 0; c < all.cols(); ++c) {
    Eigen::MatrixXd q = all.col(c).replicate(1, 2 * n + 1);
    for (int j = 0; j < n; ++j) {
      q(j, 1 + 2 * j) += kStep;
      q(j, 2 + 2 * j) -= kStep;
    }
    ObstacleQuadratics quadratics(n, static_cast<int>(q.cols()));
    objective.Evaluate(
        q, std::vector<const sdf::FieldSlice*>(static_cast<std::size_t>(q.cols()), slice.get()),
        quadratics);
    if (quadratics.cost(0) == 0) continue;
    const Eigen::VectorXd gradient = quadratics.Get(0).gradient;
    for (int j = 0; j < n; ++j) {
      const double slope = (quadratics.cost(1 + 2 * j) - quadratics.cost(2 + 2 * j)) / (2 * kStep);
      // At the seams of hinges, and where two pairs of spheres are equally near, slopes jump.
      EXPECT_NEAR(gradient(j), slope, 1e-3 * (1 + gradient.norm()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Robots, ObstacleObjectiveOf,
    ::testing::Values(Case{"Panda", "models/panda/robot.yaml", 0.2, 0.05},
                      Case{"PandaThatKeepsItsLinksFarApart", "models/panda/robot.yaml", 0.05, 0.3},
                      Case{"PandaWithoutLinks", "models/panda/robot.yaml", 0.2, std::nullopt},
                      Case{"Wam", "models/wam/robot.yaml", 0.3, 0.05},
                      Case{"JointTree", "tests/data/joint_tree/robot.yaml", 0.3, 0.4},
                      Case{"FoldingArm", "tests/support/folding_arm.yaml", 0.3, 0.2}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep::planner::obstacle_objective_test
