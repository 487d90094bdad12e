#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sidestep::robot {

/// An 8-bit grey picture, rows from the top.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< width x height, row by row

  std::uint8_t At(int x, int y) const { return pixels[Index(x, y)]; }
  std::uint8_t& At(int x, int y) { return pixels[Index(x, y)]; }
  bool operator==(const GreyImage&) const = default;

 private:
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// A pinhole camera with the distortion of Brown and Conrady, as OpenCV has it. Its frame C: x to
/// the right of the image, y down, z forward. A whole number of pixels is the centre of a pixel:
/// (0, 0) is that of the first, not its corner.
struct CameraIntrinsics {
  int width = 0, height = 0;              ///< pixels
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels
  std::array<double, 5> distortion = {};  ///< k1, k2, p1, p2, k3
  bool operator==(const CameraIntrinsics&) const = default;
};

/// The intrinsics of a lens without distortion with square pixels, its axis in the middle of the
/// image.
CameraIntrinsics PinholeOf(int width, int height, double horizontal_field_of_view_rad);

/// Where the lens puts what an ideal one would see at (x/z, y/z).
Eigen::Vector2d Distort(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal);

/// The pixel of a point with z > 0 in C.
Eigen::Vector2d Project(const CameraIntrinsics& camera, const Eigen::Vector3d& p_C);

/// The (x/z, y/z) of what is seen at a pixel: the inverse of Project, by Newton's method. Where the
/// lens folds its image (far outside it) the answer means nothing.
Eigen::Vector2d Unproject(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

}  // namespace sidestep::robot
