#include "sidestep/bench/robot_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/random_points.h"

namespace sidestep::bench::robot_filter_test {
namespace {

scenarios::Scenario SeenFrom(const Eigen::Vector3d& position_m, double margin_m,
                             double noise_per_m) {
  scenarios::Scenario scenario;
  scenario.sensor.name = "depth_camera";
  scenarios::CameraSettings camera;
  camera.position_m = position_m;
  camera.sees_robot = true;
  camera.robot_margin_m = margin_m;
  camera.noise_per_m = noise_per_m;
  scenario.sensor.camera = camera;
  return scenario;
}

robot::RobotModel Panda() {
  return robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda",
                                 Pose::Translation({0, 0, 0.4}));
}

// The distance from the robot's spheres and capsules, by many points along their axes.
double DistanceFrom(const robot::RobotModel& robot, const Eigen::VectorXd& q,
                    const Eigen::Vector3d& p_W) {
  double least_m = std::numeric_limits<double>::infinity();
  const Eigen::Matrix3Xd p_WS = robot.ComputeSphereCenters(q, false).p_WS;
  for (Eigen::Index s = 0; s < p_WS.cols(); ++s) {
    least_m = std::min(least_m, (p_W - p_WS.col(s)).norm() - robot.sphere_radii_m()(s));
  }
  const std::vector<Pose> X_WL = robot.ComputeLinkPoses(q);
  for (const robot::CollisionCapsule& capsule : robot.capsules()) {
    const Pose X = capsule.link < 0 ? robot.X_WB() : X_WL[static_cast<std::size_t>(capsule.link)];
    for (int n = 0; n <= 500; ++n) {
      const Eigen::Vector3d p_WC = X * (capsule.p_LA + n / 500.0 * (capsule.p_LB - capsule.p_LA));
      least_m = std::min(least_m, (p_W - p_WC).norm() - capsule.radius_m);
    }
  }
  return least_m;
}

TEST(RobotFilter, TakesOutWhatIsWithinItsMarginOfTheModelAndNothingElse) {
  const robot::RobotModel robot = Panda();
  ASSERT_FALSE(robot.capsules().empty());
  RandomStream random(3, "points");
  const Eigen::Vector3d p_WC(2, 0.5, 1.5);
  for (const double noise_per_m : {0.0, 0.002}) {
    const RobotFilter filter(SeenFrom(p_WC, 0.03, noise_per_m), robot);
    EXPECT_TRUE(filter.Sees("depth_camera"));
    EXPECT_FALSE(filter.Sees("other"));
    Eigen::VectorXd q = robot.configurations().at("ready");
    q(0) += random.Uniform(-1, 1);
    Scan scan;
    scan.sensor = "depth_camera";
    scan.kind = ScanKind::kSurface;
    scan.X_WC = Pose::Translation(p_WC);
    scan.p_CP.resize(3, 4000);
    for (Eigen::Index n = 0; n < scan.p_CP.cols(); ++n) {
      scan.p_CP.col(n) = Eigen::Vector3d(0.3, 0, 0.8) + UniformPoint(random, 0.7) - p_WC;
    }
    for (int n = 0; n < 4000; ++n) scan.rays.push_back(3 * n);
    scan.p_CFree = Eigen::Vector3d(1, 2, 3);
    const Eigen::Matrix3Xd points = scan.p_CP;
    filter.Remove(q, &scan);
    ASSERT_EQ(scan.p_CP.cols() + scan.p_CFree.cols(), points.cols() + 1);
    EXPECT_EQ(scan.p_CFree.col(0), Eigen::Vector3d(1, 2, 3));
    Eigen::Index kept = 0, taken = 1;
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      const Eigen::Vector3d p = points.col(n);
      const double reach_m = 0.03 + 4 * noise_per_m * std::abs(p.z()) * p.norm();
      const double over_m = DistanceFrom(robot, q, p_WC + p) - reach_m;
      const bool was_kept = kept < scan.p_CP.cols() && scan.p_CP.col(kept) == p;
      if (was_kept) {
        EXPECT_EQ(scan.rays.at(static_cast<std::size_t>(kept++)), 3 * n);
        EXPECT_GT(over_m, -1e-5);
      } else {
        ASSERT_EQ(scan.p_CFree.col(taken++), p) << "its ray is free so far";
        EXPECT_LT(over_m, 1e-5);
      }
    }
    EXPECT_GT(taken, 100);
    EXPECT_GT(kept, 100);
    EXPECT_EQ(scan.rays.size(), static_cast<std::size_t>(kept));
  }
}

TEST(MeasuredAt, IsTheSampleNearestInTime) {
  std::vector<ControlSample> recorded(3);
  for (int i = 0; i < 3; ++i) {
    recorded[static_cast<std::size_t>(i)].t = EpisodeTime(0.1 * i);
    recorded[static_cast<std::size_t>(i)].q = Eigen::VectorXd::Constant(1, i);
  }
  const JointState now{EpisodeTime(0.3), Eigen::VectorXd::Constant(1, 3), {}};
  const std::pair<double, double> cases[] = {{-1, 0},   {0, 0},    {0.04, 0}, {0.06, 1},
                                             {0.19, 2}, {0.24, 2}, {0.26, 3}, {5, 3}};
  for (const auto& [t_s, q] : cases) {
    EXPECT_EQ(MeasuredAt(EpisodeTime(t_s), recorded, now)(0), q) << t_s;
  }
  EXPECT_EQ(MeasuredAt(EpisodeTime(0), {}, now)(0), 3);
}

}  // namespace
}  // namespace sidestep::bench::robot_filter_test
