#pragma once

#include <cstdint>
#include <vector>

#include "sidestep/robot/camera_image.h"

namespace sidestep::render {

/// Makes a camera's picture of an ideal one: an undistorted picture of twice the pixels along each
/// axis, which holds all that the lens shows. Each pixel is the blurred ideal picture where the
/// lens has it; the blur is a normal one together with the pixel's own area.
class Lens {
 public:
  Lens(const robot::CameraIntrinsics& camera, double blur_px);

  const robot::CameraIntrinsics& camera() const { return camera_; }

  /// The ideal picture: its size, and where its outer edges are at z = 1 (y down).
  int ideal_width() const { return width_; }
  int ideal_height() const { return height_; }
  double left() const { return left_; }
  double top() const { return top_; }
  double right() const { return left_ + width_ * step_; }
  double bottom() const { return top_ + height_ * step_; }

  /// @param ideal brightness of each pixel, row by row from the upper left.
  /// @return the same for the camera's pixels, not rounded.
  std::vector<float> Apply(const std::vector<float>& ideal) const;

 private:
  // Four neighbours in the ideal picture, the first of them, and how far it is to the others.
  struct Source {
    std::int32_t index;
    float right, down;
  };

  void Blur(std::vector<float>* picture) const;

  robot::CameraIntrinsics camera_;
  int width_ = 0, height_ = 0;
  double left_ = 0, top_ = 0, step_ = 0;
  std::vector<float> kernel_;    // one half of it, from the middle on
  std::vector<Source> sources_;  // of each pixel of the camera
};

}  // namespace sidestep::render
