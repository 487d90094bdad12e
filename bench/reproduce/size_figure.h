#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/report/figure.h"

namespace sidestep::bench {

/// What was measured over the size of the grid, and the published figures for the same.
struct SizeCurve {
  std::string words;                                  ///< for the key
  std::vector<double> voxels, y;                      ///< a point a size
  std::vector<double> low, high;                      ///< of its band; empty: none
  std::vector<double> published_voxels, published_y;  ///< may be empty
};

/// One panel with a logarithmic y axis: a curve each, and rings of its colour for what is
/// published.
Figure MakeSizeFigure(const std::string& title, const std::string& y_label,
                      const std::vector<SizeCurve>& curves);

}  // namespace sidestep::bench
