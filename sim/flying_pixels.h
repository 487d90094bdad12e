#pragma once

#include <vector>

namespace sidestep::sim {

/// Depths by pixel [m], row by row from above, each from left to right; infinite where there is
/// none.
struct DepthImage {
  int width = 0, height = 0;
  std::vector<double> depths_m;
};

/// Which pixels measure neither what is before an edge of depth nor what is behind it: those that
/// lie, in their row or in their column, between two neighbours of which one is nearer and the
/// other farther by more than edge_m > 0. A surface is found to fly only where it is so steep that
/// it gains that much in each of two pixels. With edge_m 0 none is.
std::vector<bool> FindFlyingPixels(const DepthImage& image, double edge_m);

}  // namespace sidestep::sim
