#include "sidestep/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sidestep::render {
namespace {

// Along one axis of the picture: where the camera may stand.
struct Span {
  double depth;  // the greatest depth of the camera along the view at which all points fit
  double low_tangent, high_tangent;
  double low, high;  // min of s - high_tangent * depth, ... over the points
};

// A point at (side s, depth f) is seen from (c, d) iff low * (f - d) <= s - c <= high * (f - d):
//   c - low * d <= s - low * f   and   c - high * d >= s - high * f, for all points.
Span FitAxis(const Eigen::RowVectorXd& side, const Eigen::RowVectorXd& depth, double low_tangent,
             double high_tangent) {
  const double most = (side - low_tangent * depth).minCoeff();
  const double least = (side - high_tangent * depth).maxCoeff();
  return {(most - least) / (high_tangent - low_tangent), low_tangent, high_tangent, least, most};
}

// The middle of what is allowed for c at depth d.
double Middle(const Span& span, double d) {
  return (span.low + span.high_tangent * d + span.high + span.low_tangent * d) / 2;
}

}  // namespace

Eigen::Vector3d CameraView::forward() const {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

CameraView FitCamera(const Eigen::Matrix3Xd& points_m, double azimuth_rad, double elevation_rad,
                     const Frustum& frustum) {
  CameraView view;
  view.azimuth_rad = azimuth_rad;
  view.elevation_rad = elevation_rad;
  const Eigen::Vector3d forward = view.forward();
  const Eigen::Vector3d right(std::sin(azimuth_rad), -std::cos(azimuth_rad), 0);
  const Eigen::Vector3d up = right.cross(forward);
  const Eigen::RowVectorXd depth = forward.transpose() * points_m;
  const Span across = FitAxis(right.transpose() * points_m, depth, frustum.left, frustum.right);
  const Span upright = FitAxis(up.transpose() * points_m, depth, frustum.bottom, frustum.top);
  const double d = std::min(across.depth, upright.depth);
  const Eigen::Vector3d position =
      d * forward + Middle(across, d) * right + Middle(upright, d) * up;
  view.distance_m = std::max(0.1, depth.mean() - d);
  view.lookat_m = position + view.distance_m * forward;
  return view;
}

}  // namespace sidestep::render
