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

/// From so much on, one of two poses is not trusted. Source: a rule of thumb of PhotonVision's
/// documentation.
inline constexpr double kAmbiguous = 0.2;

/// Where a body was seen.
struct BodyPose {
  Pose X_CO;
  /// Of the errors of position and of rotation (a rotation vector), both in the axes of C; m, rad.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int num_tags = 0;
  double reprojection_px = 0;  ///< root mean square over all corners, x and y alike
  /// The errors of this pose to those of the other way to see it, from 0 (nobody could confuse
  /// them) to 1 (nobody could tell them apart); what further faces and a prior say counts. From
  /// kAmbiguous on, the covariance holds how far the two are apart.
  double ambiguity = 0;
};

/// The standard deviation of an edge of a tag across itself [px]. A corner is where two edges meet,
/// so its own error is the larger the more acute it is. `large` is that of a tag that is seen large
/// and from the front; one of this width (its area by its longest edge) has
///   large (1 + (20 px / width)^2) (1 + (0.35 longest / width)^4),
/// the more the smaller its modules and the more it is seen from the side: measured with rendered
/// pictures (docs/hardware.md).
double EdgeSigma(double large_px, double width_px, double longest_px);
inline constexpr double kEdgeSigma_px = 0.062;  ///< `large` of pictures without flaws

/// The pose that explains the edges of all tags of a body best, in pixels: a joint least-squares
/// fit from either solution of the largest tag (hardware/planar_pose.h).
/// @param edge_sigma_px of a large tag's edge, as of EdgeSigma.
/// @return nothing if none of its tags is among `seen`, or nothing could explain them.
std::optional<BodyPose> LocateBody(const robot::CameraIntrinsics& camera, const TaggedBody& body,
                                   const std::vector<TagDetection>& seen, double edge_sigma_px,
                                   const std::optional<RotationPrior>& prior = std::nullopt);

}  // namespace sidestep::hardware
