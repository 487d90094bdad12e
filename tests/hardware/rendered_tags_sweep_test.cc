// Over distances and tilts, at the resolution of a real camera: slow, since software draws it.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>

#include "sidestep/core/random.h"
#include "sidestep/hardware/tag_detector.h"
#include "sidestep/hardware/tag_sensor.h"
#include "tests/hardware/posed_tags.h"

namespace sidestep {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const Eigen::Vector3d kPlate(0.20, 0.20, 0.02);

struct Look {
  double distance_m, tilt_rad;
  Pose X_CO;
};

// A tag of 16 cm in the middle of a plate, whole in the picture, turned any way about its own
// normal, which is tilted to any side from the line of sight.
std::vector<Look> Looks(RandomStream& random, int count) {
  std::vector<Look> looks;
  while (static_cast<int>(looks.size()) < count) {
    const double distance_m = random.Uniform(0.5, 2), tilt_rad = random.Uniform(0, 60 * kDegree);
    const Eigen::Vector3d sight =
        Eigen::Vector3d{random.Uniform(-0.6, 0.6), random.Uniform(-0.33, 0.33), 1}.normalized();
    const double side_rad = random.Uniform(-std::numbers::pi, std::numbers::pi);
    const Eigen::Quaterniond R_CT =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), sight) *
        Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(std::cos(side_rad), std::sin(side_rad), 0)) *
        Eigen::AngleAxisd(random.Uniform(-std::numbers::pi, std::numbers::pi),
                          Eigen::Vector3d::UnitZ());
    const Pose X_CT(R_CT, distance_m * sight);
    const robot::CameraIntrinsics camera = robot::PinholeOf(1280, 720, 1.211);
    const auto is_inside = [&](double x, double y) {
      const Eigen::Vector2d at = robot::Project(camera, X_CT * Eigen::Vector3d(x, y, 0));
      return at.x() > 3 && at.y() > 3 && at.x() < camera.width - 4 && at.y() < camera.height - 4;
    };
    if (!(is_inside(-0.1, -0.1) && is_inside(-0.1, 0.1) && is_inside(0.1, -0.1) &&
          is_inside(0.1, 0.1))) {
      continue;
    }
    looks.push_back({distance_m, tilt_rad, X_CT * scenarios::TagPose(kPlate, "+z").Inverse()});
  }
  return looks;
}

TEST(RenderedTagsSweep, FindsOneOfSixteenCentimetresToTwoMetresAndSixtyDegrees) {
  if (!hardware::CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  RandomStream random(5, "looks");
  constexpr int kCount = 400;
  const std::vector<Look> looks = Looks(random, kCount);
  std::vector<Pose> poses;
  for (const Look& look : looks) poses.push_back(look.X_CO);
  PosedTags scene(poses, kPlate, "[{face: +z, id: 5, size_m: 0.16}]");
  hardware::TagDetector detector;
  int found = 0;
  struct Errors {
    int count = 0;
    double across_m2 = 0, along_m2 = 0, nees = 0;
  };
  std::map<int, Errors> by_distance;  // in half metres
  for (const Look& look : looks) {
    const robot::Frame frame = scene.Take();
    const auto pose = hardware::LocateBody(frame.camera, scene.body(), detector.Detect(frame.image),
                                           hardware::kEdgeSigma_px);
    if (!pose || pose->reprojection_px > hardware::TagSensorOptions().most_reprojection_px)
      continue;
    ++found;
    const Eigen::Vector3d error = pose->X_CO.translation() - scene.X_CO().translation();
    const Eigen::Vector3d sight = scene.X_CO().translation().normalized();
    const double along_m = error.dot(sight);
    Errors& errors = by_distance[static_cast<int>(look.distance_m * 2)];
    ++errors.count;
    errors.along_m2 += along_m * along_m;
    errors.across_m2 += (error.squaredNorm() - along_m * along_m) / 2;
    errors.nees += error.dot(pose->covariance.topLeftCorner<3, 3>().ldlt().solve(error));
  }
  EXPECT_GE(found, 0.99 * kCount);
  double nees = 0;
  for (const auto& [half_metres, errors] : by_distance) {
    const double far_m = (half_metres + 1) / 2.0;
    const double across_m = std::sqrt(errors.across_m2 / errors.count);
    const double along_m = std::sqrt(errors.along_m2 / errors.count);
    std::cout << "to " << far_m << " m: " << errors.count << " looks, across " << 1e3 * across_m
              << " mm, along " << 1e3 * along_m << " mm, NEES " << errors.nees / errors.count
              << "\n";
    // A filter's figures for real cameras: 2 mm + 1 mm/m across, 3 mm at 1 m and 16 cm along.
    EXPECT_LT(across_m, 0.002 + 0.001 * far_m);
    EXPECT_LT(along_m, 0.003 * far_m * far_m);
    nees += errors.nees;
  }
  // Of three errors: 95 % of a chi-square by its normal approximation.
  EXPECT_NEAR(nees / found, 3, 1.96 * std::sqrt(2.0 * 3 / found));
}

}  // namespace
}  // namespace sidestep
