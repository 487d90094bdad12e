#include "sidestep/cli/slice_axes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace sidestep::cli {
namespace {

constexpr int kTick = 5, kGap = 4;  // pixels
constexpr int kTitle = kLetters + 2 * kGap, kBottom = kTick + kLetters + 2 * kGap, kRight = 16;
constexpr double kPixelsATick = 60;

std::string Label(double value_m, double step_m) {
  const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step_m) - 1e-9)));
  return fmt::format("{:.{}f}", value_m + 0.0, digits);  // + 0.0: no "-0"
}

// Calls draw(pixel from the low end, label) for each tick of an axis.
template <class Draw>
void ForEachTick(double low_m, double high_m, int pixels, const Draw& draw) {
  const double step_m = TickStep(high_m - low_m, std::max(1.0, pixels / kPixelsATick));
  for (double n = std::ceil(low_m / step_m - 1e-9); n * step_m <= high_m + 1e-9 * step_m; ++n) {
    const double value_m = n * step_m;
    const double share = (value_m - low_m) / (high_m - low_m);
    draw(static_cast<int>(std::lround(share * (pixels - 1))), Label(value_m, step_m));
  }
}

}  // namespace

double TickStep(double range, double most) {
  const double power = std::pow(10.0, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (range / (factor * power) <= most * (1 + 1e-9)) return factor * power;
  }
  return 10 * power;
}

SliceExtent ExtentOf(const GridSpec& grid) {
  const Eigen::Vector3d low = grid.first_center_m.array() - grid.cell_m / 2;
  return {low.x(), low.x() + grid.cell_m * grid.size[0], low.y(),
          low.y() + grid.cell_m * grid.size[1]};
}

render::Image WithAxes(const render::Image& slice, const SliceExtent& extent,
                       const std::string& title, const render::Font& font) {
  const int width = slice.width(), height = slice.height();
  const int top = title.empty() ? kLetters / 2 : kTitle;  // the uppermost tick has a number
  render::Image image(kPlotLeft + width + kRight, top + height + kBottom);
  image.Fill({0, 0, image.width(), image.height()}, kPaper);
  font.Draw(image, kPlotLeft, kGap, kLetters, kInk, title);
  image.Outline({kPlotLeft - 1, top - 1, width + 2, height + 2}, kInk, 1);
  image.Paste(slice, kPlotLeft, top);
  ForEachTick(extent.x_low_m, extent.x_high_m, width, [&](int pixel, const std::string& label) {
    image.Fill({kPlotLeft + pixel, top + height, 1, kTick}, kInk);
    font.Draw(image, kPlotLeft + pixel - font.Width(label, kLetters) / 2,
              top + height + kTick + kGap, kLetters, kInk, label);
  });
  ForEachTick(extent.y_low_m, extent.y_high_m, height, [&](int pixel, const std::string& label) {
    const int y = top + height - 1 - pixel;
    image.Fill({kPlotLeft - kTick, y, kTick, 1}, kInk);
    const int half_letter = kLetters / 2;
    font.Draw(image, kPlotLeft - kTick - kGap - font.Width(label, kLetters), y - half_letter,
              kLetters, kInk, label);
  });
  font.Draw(image, kGap, top + height + kTick + kGap, kLetters, kInk, "m");
  return image;
}

}  // namespace sidestep::cli
