#pragma once

#include <Eigen/Core>

namespace sidestep::render {

/// Where to look from, as MuJoCo's free camera has it: at `lookat_m` from `distance_m` away; the
/// view goes towards azimuth (from x to y) and elevation (negative: down).
struct CameraView {
  Eigen::Vector3d lookat_m = Eigen::Vector3d::Zero();
  double distance_m = 1;
  double azimuth_rad = 0;
  double elevation_rad = 0;

  Eigen::Vector3d forward() const;  ///< unit length
  Eigen::Vector3d position_m() const { return lookat_m - distance_m * forward(); }
};

/// What a picture shows of the plane at distance 1 from the camera: from `left` to `right` and from
/// `bottom` to `top` of the view's axis, each the tangent of an angle.
struct Frustum {
  double left = 0, right = 0, bottom = 0, top = 0;
};

/// The nearest view in this direction that holds all points (3 x N, m, N >= 1) within the frustum.
/// Exact: each side of the frustum bounds the camera's position linearly.
CameraView FitCamera(const Eigen::Matrix3Xd& points_m, double azimuth_rad, double elevation_rad,
                     const Frustum& frustum);

}  // namespace sidestep::render
