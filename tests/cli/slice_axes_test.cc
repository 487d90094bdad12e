#include "sidestep/cli/slice_axes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sidestep/render/gl_context.h"

namespace sidestep::cli {
namespace {

TEST(TickStep, IsOneTwoOrFiveTimesAPowerOfTenAndLeavesFewEnough) {
  EXPECT_DOUBLE_EQ(TickStep(3.84, 5), 1);
  EXPECT_DOUBLE_EQ(TickStep(1, 5), 0.2);
  EXPECT_DOUBLE_EQ(TickStep(1, 4), 0.5);
  EXPECT_DOUBLE_EQ(TickStep(0.03, 6), 0.005);
  for (double range = 0.001; range < 1000; range *= 1.37) {
    for (const double most : {1.0, 3.0, 10.0}) {
      const double step = TickStep(range, most);
      EXPECT_LE(range / step, most * (1 + 1e-6));
      EXPECT_GT(range / step, most / 2.6);
    }
  }
}

// The dark pixels of the frame's left border, below the picture's edge: its ticks.
TEST(WithAxes, PutsTicksWhereTheMetresAre) {
  constexpr render::Color kPaper{255, 255, 255}, kSlice{200, 100, 50};
  const render::GlContext gl;
  const render::Font font(gl);
  render::Image slice(201, 101);
  slice.Fill({0, 0, 201, 101}, kSlice);
  const render::Image image = WithAxes(slice, {-1, 1, 0, 1}, "0.5 s", font);
  int left = 0, top = 0;
  while (!(image.At(left, image.height() / 2) == kSlice)) ++left;
  while (!(image.At(image.width() / 2, top) == kSlice)) ++top;
  EXPECT_EQ(image.At(left + 200, top + 100), kSlice);
  // Along x a tick each metre: at the ends and in the middle, in the row below the frame.
  for (int x = 0; x <= 200; ++x) {
    const bool is_tick = !(image.At(left + x, top + 101 + 2) == kPaper);
    EXPECT_EQ(is_tick, x % 100 == 0) << x;
  }
  for (int y = 0; y <= 100; ++y) {
    const bool is_tick = !(image.At(left - 3, top + y) == kPaper);
    EXPECT_EQ(is_tick, y % 100 == 0) << y;
  }
}

}  // namespace
}  // namespace sidestep::cli
