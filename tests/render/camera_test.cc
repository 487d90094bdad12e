#include "sidestep/render/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/random_points.h"

namespace sidestep::render::camera_test {
namespace {

// Where a camera sees points: tangents to the right and up, one column a point.
Eigen::Matrix2Xd Project(const CameraView& view, const Eigen::Matrix3Xd& points) {
  const Eigen::Vector3d forward = view.forward();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d up = right.cross(forward);
  Eigen::Matrix2Xd seen(2, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d p = points.col(i) - view.position_m();
    const double depth = p.dot(forward);
    EXPECT_GT(depth, 0) << "a point is behind the camera";
    seen.col(i) = Eigen::Vector2d(p.dot(right), p.dot(up)) / depth;
  }
  return seen;
}

struct Case {
  double azimuth_rad, elevation_rad;
  Frustum frustum;
};

TEST(FitCamera, HoldsEveryPointAndCannotComeNearer) {
  RandomStream random(1, "points");
  const Case cases[] = {{0, -0.5, {-0.5, 0.5, -0.3, 0.3}},
                        {2.1, -0.2, {-0.2, 0.4, -0.3, 0.1}},
                        {-1.3, 0.4, {-0.1, 0.1, -0.6, 0.6}},
                        {3.1, -1.2, {-0.7, 0.7, -0.1, 0.2}}};
  for (const Case& c : cases) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      Eigen::Matrix3Xd points(3, 12);
      for (auto point : points.colwise()) {
        point = UniformPoint(random, 1).cwiseProduct(Eigen::Vector3d(3, 1, 1));
        point.z() += 2;
      }
      const CameraView view = FitCamera(points, c.azimuth_rad, c.elevation_rad, c.frustum);
      const Eigen::Matrix2Xd seen = Project(view, points);
      const double left = seen.row(0).minCoeff() - c.frustum.left;
      const double right = c.frustum.right - seen.row(0).maxCoeff();
      const double bottom = seen.row(1).minCoeff() - c.frustum.bottom;
      const double top = c.frustum.top - seen.row(1).maxCoeff();
      EXPECT_GE(std::min({left, right, bottom, top}), -1e-9);
      // Two opposite sides are touched, so that any nearer camera loses a point.
      EXPECT_LT(std::min(std::max(left, right), std::max(bottom, top)), 1e-9);
    }
  }
}

TEST(FitCamera, LooksInTheDirectionItIsTold) {
  const Eigen::Matrix3Xd point = Eigen::Vector3d(1, 2, 3);
  const CameraView view = FitCamera(point, 0.7, -0.4, {-0.5, 0.5, -0.3, 0.3});
  EXPECT_NEAR(std::atan2(view.forward().y(), view.forward().x()), 0.7, 1e-12);
  EXPECT_NEAR(std::asin(view.forward().z()), -0.4, 1e-12);
  EXPECT_GT(view.distance_m, 0);
}

}  // namespace
}  // namespace sidestep::render::camera_test
