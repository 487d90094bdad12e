#pragma once

#include <string>

#include "sidestep/core/grid.h"
#include "sidestep/render/font.h"
#include "sidestep/render/image.h"

namespace sidestep::cli {

inline constexpr render::Color kPaper{255, 255, 255}, kInk{20, 20, 30};
inline constexpr int kLetters = 14, kPlotLeft = 48;  // pixels: of the text, and left of the picture

/// What a picture of a level slice shows of the world, edge to edge [m].
struct SliceExtent {
  double x_low_m = 0, x_high_m = 0, y_low_m = 0, y_high_m = 0;
};

/// Of all cells of a grid.
SliceExtent ExtentOf(const GridSpec& grid);

/// The picture, x to the right and y upwards, in a frame with ticks in metres, and a title above
/// unless it is empty.
render::Image WithAxes(const render::Image& slice, const SliceExtent& extent,
                       const std::string& title, const render::Font& font);

/// The distance between ticks for a range: 1, 2 or 5 times a power of ten, and the least of those
/// that leaves at most `most` steps. @param range > 0. @param most >= 1.
double TickStep(double range, double most);

}  // namespace sidestep::cli
