#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/shape.h"
#include "sidestep/hardware/tag_detector.h"
#include "sidestep/robot/camera_image.h"

namespace sidestep::hardware {

/// A tag that is fixed to a body.
struct BodyTag {
  int id = 0;
  double size_m = 0;  ///< the edge of its black square
  Pose X_OT;          ///< x to the right of the print, y down, z into the body
};

/// A thing that bears tags on one or more of its faces.
struct TaggedBody {
  std::string name;
  Shape shape;
  std::vector<BodyTag> tags;
};

/// How a body is believed to be turned, before it is looked at.
struct RotationPrior {
  Eigen::Quaterniond R_CO = Eigen::Quaterniond::Identity();
  double sigma_rad = 0;  ///< about each axis
};

/// Where a body was seen.
struct BodyPose {
  Pose X_CO;
  /// Of the errors of position and of rotation (a rotation vector), both in the axes of C; m, rad.
  /// Where the errors of edges explain what is left less often than once in a hundred times, it is
  /// larger by as much as that takes.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int num_tags = 0;
  double reprojection_px = 0;  ///< root mean square over all corners, x and y alike
  /// How likely the other way to see it is, for one of this, from 0 (nobody could confuse them) to
  /// 1 (nobody could tell them apart); what further faces and a prior say counts. The covariance
  /// holds how far the two are apart, as likely as that is.
  double ambiguity = 0;
};

/// How an edge of a tag errs across itself [px]: its middle, and each end beyond that, one up and
/// one down, by `turn`. The detector looks for an edge at N even places along it, one every 8 px
/// and at least 16, and lays a line through them. Each place errs by sigma, one as if there were no
/// other: that leaves middle = sigma / sqrt(N) and turn = middle sqrt(3 (N + 1) / (N - 1)).
/// Besides, grey levels are read at whole pixels, so that a place errs by where it lies among them.
/// Of that, what comes back with each half pixel that the edge crosses is large for edges along the
/// rows or columns, 2.4 sigma / (1 + 20 slope); what comes back with each pixel along it is 0.4
/// sigma. As places are even, they sample these waves: where the step from one to the next is a
/// whole number of waves, all of them err alike, and nothing averages out. Sources: refine_edges of
/// AprilRobotics/apriltag 3.3.0; the law of the straight line fitted to even places; the sizes as
/// measured with 680 rendered pictures (docs/hardware.md).
struct EdgeErrors {
  double middle_px = 0, turn_px = 0;
};
EdgeErrors ErrorsOfEdge(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                        double sigma_px);
inline constexpr double kEdgeSigma_px = 0.082;  ///< of rendered pictures (docs/sensors.md)

/// The pose that explains the edges of all tags of a body best, in pixels: a joint least-squares
/// fit from either solution of the largest tag (hardware/planar_pose.h).
/// @param edge_sigma_px of one place of an edge, as of ErrorsOfEdge.
/// @return nothing if none of its tags is among `seen`, or nothing could explain them.
std::optional<BodyPose> LocateBody(const robot::CameraIntrinsics& camera, const TaggedBody& body,
                                   const std::vector<TagDetection>& seen, double edge_sigma_px,
                                   const std::optional<RotationPrior>& prior = std::nullopt);

}  // namespace sidestep::hardware
