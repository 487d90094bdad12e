#include "sidestep/robot/camera_image.h"

#include <Eigen/LU>
#include <cmath>

namespace sidestep::robot {

CameraIntrinsics PinholeOf(int width, int height, double horizontal_field_of_view_rad) {
  CameraIntrinsics camera{.width = width, .height = height};
  camera.fx = camera.fy = width / 2.0 / std::tan(horizontal_field_of_view_rad / 2);
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return camera;
}

Eigen::Vector2d Distort(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = ideal.x(), y = ideal.y(), r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Vector2d Project(const CameraIntrinsics& camera, const Eigen::Vector3d& p_C) {
  const Eigen::Vector2d at = Distort(camera, p_C.head<2>() / p_C.z());
  return {camera.fx * at.x() + camera.cx, camera.fy * at.y() + camera.cy};
}

Eigen::Vector2d Unproject(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d seen((pixel.x() - camera.cx) / camera.fx,
                             (pixel.y() - camera.cy) / camera.fy);
  Eigen::Vector2d ideal = seen;
  constexpr int kMostSteps = 20;
  constexpr double kStep = 1e-7, kEnough = 1e-12;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector2d off = Distort(camera, ideal) - seen;
    if (off.norm() < kEnough) break;
    Eigen::Matrix2d J;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d aside = kStep * Eigen::Vector2d::Unit(axis);
      J.col(axis) = (Distort(camera, ideal + aside) - Distort(camera, ideal - aside)) / (2 * kStep);
    }
    ideal -= J.inverse() * off;
  }
  return ideal;
}

}  // namespace sidestep::robot
