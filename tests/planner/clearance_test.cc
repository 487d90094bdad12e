// The judge of plans looks at most moments in a fast way only; what it says is what a look at each
// of them would, to the last bit.

#include "sidestep/planner/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "sidestep/core/random.h"
#include "sidestep/core/shape.h"
#include "sidestep/planner/guarded_spheres.h"
#include "sidestep/planner/self_clearance.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"

namespace sidestep::planner::clearance_test {
namespace {

constexpr double kClamp_m = 0.35;

sdf::CompositeField Room(std::uint64_t seed) {
  RandomStream random(seed, "room");
  OccupancyGrid grid({Eigen::Vector3d::Constant(-0.8), 0.05, {33, 33, 33}});
  for (auto& cell : grid.cells) cell = random.Uniform() < 0.0002 ? 1 : 0;
  const auto shape =
      std::make_shared<const sdf::SdfGrid>(sdf::MakeShapeField(Box{{0.2, 0.3, 1}}, 0.05, kClamp_m));
  return sdf::CompositeField(std::make_shared<const sdf::SdfGrid>(sdf::ComputeSignedDistance(grid)),
                             {{shape,
                               [](EpisodeTime t) {
                                 return Pose::Translation({0.6, t.seconds() - 1.5, 0.4});
                               }}},
                             kClamp_m);
}

// The definition.
Clearance ByEachMoment(const robot::RobotModel& robot, const sdf::DistanceField& field,
                       const Trajectory& trajectory, EpisodeTime start, EpisodeTime from,
                       EpisodeTime to, double step_s) {
  const SelfClearance links(robot);
  const double duration_s = std::max(0.0, (to - from).seconds());
  const int num_steps = static_cast<int>(std::ceil(duration_s / step_s));
  Clearance clearance;
  for (int i = 0; i <= num_steps; ++i) {
    const EpisodeTime t = from + HorizonOffset(std::min(duration_s, i * step_s));
    const robot::SphereCenters centers =
        robot.ComputeSphereCenters(Sample(trajectory, t - start).q, /*with_jacobian=*/false);
    clearance.least_m = std::min(clearance.least_m, links.Least(centers.p_WS));
    for (const int s : GuardedSpheres(robot)) {
      const sdf::DistanceSample sample = field.Sample(centers.p_WS.col(s), t);
      clearance.samples_outside_grid += sample.in_grid ? 0 : 1;
      clearance.least_m =
          std::min(clearance.least_m, sample.distance_m - robot.sphere_radii_m()(s));
    }
    if (clearance.least_m <= 0 && !clearance.first_contact) clearance.first_contact = t;
  }
  return clearance;
}

Trajectory RandomMotion(const robot::RobotModel& robot, RandomStream& random, double reach_rad) {
  const int n = robot.num_joints(), K = 6;
  const Eigen::VectorXd middle = robot.configurations().begin()->second;
  Trajectory motion{Eigen::VectorXd::LinSpaced(K, 0, 2.5), Eigen::MatrixXd(n, K),
                    Eigen::MatrixXd(n, K)};
  for (int k = 0; k < K; ++k) {
    for (int i = 0; i < n; ++i) {
      motion.q(i, k) = middle(i) + random.Uniform(-reach_rad, reach_rad);
      motion.v(i, k) = random.Normal();
    }
  }
  return motion;
}

void ExpectTheSame(const Clearance& got, const Clearance& expected) {
  EXPECT_EQ(got.least_m, expected.least_m);
  EXPECT_EQ(got.first_contact, expected.first_contact);
  EXPECT_EQ(got.samples_outside_grid, expected.samples_outside_grid);
}

TEST(MeasureClearance, SaysWhatEachMomentSays) {
  for (const std::string name : {"panda", "wam"}) {
    const robot::RobotModel robot =
        robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", name, Pose());
    int num_contacts = 0, num_outside = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      RandomStream random(seed, "motion");
      const auto field = Room(seed);
      const Trajectory motion = RandomMotion(robot, random, seed % 2 == 0 ? 0.7 : 0.15);
      const EpisodeTime start(0.3), from(0.25), to(3.1);  // rests at both ends
      const double step_s = seed % 3 == 0 ? 0.005 : 0.02;
      const Clearance expected = ByEachMoment(robot, field, motion, start, from, to, step_s);
      ExpectTheSame(MeasureClearance(robot, field, motion, start, from, to, step_s), expected);
      num_contacts += expected.first_contact.has_value();
      num_outside += expected.samples_outside_grid > 0;
    }
    EXPECT_GT(num_contacts, 3);
    EXPECT_LT(num_contacts, 38);
    EXPECT_GT(num_outside, 5);
  }
}

TEST(MeasureClearance, SaysSoOfJointsThatTurnAsFarAsTheyLike) {
  const robot::RobotModel robot =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  RandomStream random(1, "motion");
  const auto field = Room(1);
  const Trajectory motion = RandomMotion(robot, random, 1e12);
  const EpisodeTime start(0), to(2.5);
  ExpectTheSame(MeasureClearance(robot, field, motion, start, start, to),
                ByEachMoment(robot, field, motion, start, start, to, 0.02));
}

}  // namespace
}  // namespace sidestep::planner::clearance_test
