// The faster back ends against their oracle, `gpmp`: the same iterations to the same cost, whatever
// the problem.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/core/shape.h"
#include "sidestep/planner/registry.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"
#include "tests/sdf/only_target.h"

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

class FasterPlanner : public ::testing::TestWithParam<std::string> {};

TEST_P(FasterPlanner, TakesTheIterationsOfItsOracleToTheSameCost) {
  const robot::RobotModel panda = Panda();
  for (const int num_interpolated : {0, 1, 4}) {
    PlannerSettings settings;
    settings.num_interpolated = num_interpolated;
    settings.num_detours = 1;
    const auto oracle = MakePlanner("gpmp", panda, settings);
    const auto fast = MakePlanner(GetParam(), panda, settings);
    int num_same = 0, num_all = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const auto field = Room(seed);
      PlanRequest request = Request(panda, field, seed);
      const PlanResult expected = oracle->Plan(request), got = fast->Plan(request);
      ++num_all;
      // Where a field's gradient jumps, a bit may decide which way a search goes; seldom.
      if (expected.iterations != got.iterations) continue;
      ++num_same;
      EXPECT_NEAR(got.cost.total(), expected.cost.total(), 1e-5 * expected.cost.total());
      EXPECT_NEAR(got.clearance.least_m, expected.clearance.least_m, 1e-5);
      EXPECT_EQ(got.status, expected.status);

      request.initial = expected.trajectory;
      const PlanResult warm_expected = oracle->Plan(request), warm_got = fast->Plan(request);
      EXPECT_NEAR(warm_got.cost.total(), warm_expected.cost.total(),
                  1e-5 * warm_expected.cost.total());
    }
    EXPECT_GE(num_same, num_all - 2);
  }
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
    EXPECT_EQ(plan.trajectory.q, first->trajectory.q);
    EXPECT_EQ(plan.trajectory.v, first->trajectory.v);
    EXPECT_EQ(plan.cost.total(), first->cost.total());
  }
}

INSTANTIATE_TEST_SUITE_P(BackEnds, FasterPlanner, ::testing::Values("gpmp_ceres", "gpmp_fast"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace sidestep::planner
