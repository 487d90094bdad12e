#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <vector>

#include "sidestep/robot/camera_image.h"

namespace sidestep::hardware {

/// A tag that was found in a picture.
struct TagDetection {
  int id = 0;
  int hamming = 0;    ///< bits that were wrong and have been corrected
  double margin = 0;  ///< how clearly its modules are black or white, of 255
  /// The corners of its black square [px], of the print as it stands upright: lower left, lower
  /// right, upper right, upper left. Whole numbers are the centres of pixels.
  Eigen::Matrix<double, 2, 4> corners_px;

  double shortest_edge_px() const {
    double shortest = (corners_px.col(0) - corners_px.col(3)).norm();
    for (int k = 0; k < 3; ++k) {
      shortest = std::min(shortest, (corners_px.col(k + 1) - corners_px.col(k)).norm());
    }
    return shortest;
  }
};

/// Those corners in the tag's frame T, in its middle with x right, y down, z into the print [m].
inline Eigen::Matrix<double, 3, 4> CornersOfTag(double size_m) {
  const double h = size_m / 2;
  Eigen::Matrix<double, 3, 4> p_TQ;
  p_TQ << -h, h, h, -h, h, h, -h, -h, 0, 0, 0, 0;
  return p_TQ;
}

struct TagDetectorOptions {
  /// Squares are looked for in a picture this much smaller; their edges are then found in the whole
  /// one. 2 costs no accuracy and a quarter of the time.
  double decimate = 2;
  int most_hamming = 1;
  double least_margin = 30;
  double least_edge_px = 25;
  /// Of corners, from the rim of the picture. Edges are looked for 4 px to either side of where
  /// they were found in the smaller picture: of those nearer to the rim, or beyond it, one side is
  /// not seen.
  double least_from_rim_px = 5;
};

/// Finds AprilTags of the family tag36h11 by AprilRobotics' library, in one thread, so that equal
/// pictures give equal bits. Not for two threads at once.
class TagDetector {
 public:
  /// @throws InputError if this build is without the library.
  explicit TagDetector(const TagDetectorOptions& options = {});
  ~TagDetector();
  TagDetector(const TagDetector&) = delete;
  TagDetector& operator=(const TagDetector&) = delete;

  /// By id. Of an id that is there twice, nothing: nobody knows which is meant.
  std::vector<TagDetection> Detect(const robot::GreyImage& image);

 private:
  struct Library;
  struct DeleteLibrary {
    void operator()(Library* library) const;
  };
  TagDetectorOptions options_;
  std::unique_ptr<Library, DeleteLibrary> library_;
};

/// Whether this build can find tags.
bool CanFindTags();

}  // namespace sidestep::hardware
