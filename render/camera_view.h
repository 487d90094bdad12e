#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/render/font.h"
#include "sidestep/render/image.h"
#include "sidestep/robot/camera_image.h"

namespace sidestep::render {

/// A box as it is drawn into a picture: its edges.
struct ViewedBox {
  Pose X_WO;
  Eigen::Vector3d half_extents_m;
  Color color;
  double opacity = 1;
};

/// What is known of a camera's picture.
struct CameraNotes {
  robot::CameraIntrinsics camera;
  Pose X_WC;
  std::vector<Eigen::Matrix<double, 2, 4>> tags_px;  ///< corners of each, as they were found
  std::vector<ViewedBox> boxes;
  Eigen::Matrix3Xd path_W;         ///< [m] where the tool is to go
  std::vector<std::string> lines;  ///< of text, printable ASCII
};

/// The picture in grey, and all of that drawn into it. What is behind the camera is left out.
Image DrawCameraNotes(const robot::GreyImage& picture, const CameraNotes& view, const Font& font);

}  // namespace sidestep::render
