#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/hardware/tag_detector.h"
#include "sidestep/robot/camera_image.h"

namespace sidestep::hardware {

/// A tag on the hand of a robot that rests, as a camera that stands in the world sees it.
struct HandView {
  Pose X_WH;  ///< of the hand, by the robot's joints
  TagDetection tag;
};

/// Where a camera stands, and how well that is known.
struct CameraCalibration {
  std::string serial;  ///< of the camera
  robot::CameraIntrinsics camera;
  std::string robot;  ///< by whose hand it was found
  std::string date;   ///< YYYY-MM-DD, UTC
  Pose X_WC, X_HT;    ///< of the camera, and of the tag in the hand (x right, y down, z into it)
  int num_views = 0;  ///< that it was fitted to
  double reprojection_px = 0;  ///< root mean square over their corners, x and y alike
  // Of views that it was not fitted to: where camera and robot see the tag, one from the other.
  int num_held_out = 0;
  double held_out_rms_m = 0, held_out_max_m = 0, held_out_rms_rad = 0;
};

/// What a calibration has to be to be accepted.
inline constexpr int kLeastViews = 15, kHeldOut = 5;
/// Of the hand, about each of two axes: 30 degrees.
inline constexpr double kLeastTurn_rad = 0.5236;
inline constexpr double kMostHeldOutRms_m = 0.005, kMostHeldOut_m = 0.010;
inline constexpr double kMostHeldOutRms_rad = 0.0087;  ///< half a degree
inline constexpr int kMostAge_days = 30;

/// Eye-to-hand calibration: a first estimate by OpenCV (hardware/planar_pose.h), then the poses of
/// camera and tag for which all corners are projected best, in pixels. kHeldOut of the views,
/// evenly among them, are left out and judge it. What the views do not tell (serial, robot, date)
/// is left empty.
/// @throws InputError `views: WHY` if there are too few, or the hand was turned too little.
CameraCalibration CalibrateCamera(const robot::CameraIntrinsics& camera, double tag_size_m,
                                  const std::vector<HandView>& views);

/// Why it is not good enough to be used, if it is not.
std::optional<std::string> WhyNotAccepted(const CameraCalibration& calibration);

/// Why a robot is not to be moved by what this camera sees: another camera or lens, too old, from
/// the future, or not good enough.
/// @param today YYYY-MM-DD, UTC.
std::optional<std::string> WhyNotUsable(const CameraCalibration& calibration,
                                        const std::string& serial,
                                        const robot::CameraIntrinsics& camera,
                                        const std::string& today,
                                        int most_age_days = kMostAge_days);

/// The file of a calibration, YAML. @throws InputError FILE:LINE: KEY: WHY.
CameraCalibration ReadCalibration(const std::string& path);
std::string ToYaml(const CameraCalibration& calibration);

}  // namespace sidestep::hardware
