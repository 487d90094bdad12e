#include "sidestep/robot/camera_image.h"

#include <gtest/gtest.h>

#include <numbers>

#include "sidestep/core/random.h"

namespace sidestep::robot::camera_image_test {
namespace {

CameraIntrinsics DistortedCamera() {
  CameraIntrinsics camera = PinholeOf(1280, 720, 69.4 / 180 * std::numbers::pi);
  camera.distortion = {0.12, -0.25, 0.001, -0.002, 0.08};
  return camera;
}

TEST(CameraIntrinsics, SeesThePointAheadBetweenTheMiddlePixels) {
  const CameraIntrinsics camera = PinholeOf(1280, 720, 1.2);
  EXPECT_EQ(Project(camera, {0, 0, 2}), Eigen::Vector2d(639.5, 359.5));
  // Half the angle to the right is the outer edge of the last pixel.
  const double tangent = std::tan(0.6);
  EXPECT_NEAR(Project(camera, {tangent, 0, 1}).x(), 1279.5, 1e-9);
}

TEST(CameraIntrinsics, HaveTheDistortionOfOpenCv) {
  CameraIntrinsics camera{.width = 100, .height = 100, .fx = 1, .fy = 1};
  camera.distortion = {0.1, 0.01, 0.002, 0.003, 0.001};
  // By hand: r^2 = 0.25 + 0.04 = 0.29, radial = 1 + 0.029 + 0.000841 + 0.000024389.
  const double radial = 1.029865389;
  const Eigen::Vector2d at = Distort(camera, {0.5, 0.2});
  EXPECT_NEAR(at.x(), 0.5 * radial + 2 * 0.002 * 0.1 + 0.003 * (0.29 + 0.5), 1e-12);
  EXPECT_NEAR(at.y(), 0.2 * radial + 0.002 * (0.29 + 0.08) + 2 * 0.003 * 0.1, 1e-12);
}

TEST(CameraIntrinsics, FindTheRayOfEveryPixel) {
  const CameraIntrinsics camera = DistortedCamera();
  RandomStream random(1, "pixels");
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d pixel{random.Uniform(0, 1279), random.Uniform(0, 719)};
    const Eigen::Vector2d ideal = Unproject(camera, pixel);
    EXPECT_NEAR((Project(camera, {ideal.x(), ideal.y(), 1}) - pixel).norm(), 0, 1e-8);
  }
}

}  // namespace
}  // namespace sidestep::robot::camera_image_test
