#include "sidestep/render/image.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace sidestep::render::image_test {
namespace {

constexpr Color kBlack = {0, 0, 0}, kRed = {200, 10, 20}, kWhite = {255, 255, 255};

int Count(const Image& image, Color color) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += image.At(x, y) == color;
  }
  return count;
}

TEST(Image, IsBlackAtFirstAndRefusesToBeEmpty) {
  EXPECT_EQ(Count(Image(4, 3), kBlack), 12);
  EXPECT_THROW(Image(0, 3), std::invalid_argument);
  EXPECT_THROW(Image(4, -1), std::invalid_argument);
}

TEST(Image, FillsExactlyTheRectangleCutOffAtItsEdges) {
  Image image(10, 8);
  image.Fill({2, 3, 4, 2}, kRed);
  EXPECT_EQ(Count(image, kRed), 8);
  EXPECT_EQ(image.At(2, 3), kRed);
  EXPECT_EQ(image.At(5, 4), kRed);
  EXPECT_EQ(image.At(6, 4), kBlack);
  image.Fill({-5, -5, 100, 100}, kWhite);
  EXPECT_EQ(Count(image, kWhite), 80);
}

TEST(Image, OutlinesTheInsideOfTheRectangle) {
  Image image(10, 8);
  image.Outline({1, 1, 8, 6}, kRed, 2);
  EXPECT_EQ(Count(image, kRed), 8 * 6 - 4 * 2);
  EXPECT_EQ(image.At(2, 2), kRed);
  EXPECT_EQ(image.At(3, 3), kBlack);
  EXPECT_EQ(image.At(0, 0), kBlack);
}

TEST(Image, BlendsByOpacity) {
  Image image(1, 1);
  image.Blend(0, 0, kRed, 0.5);
  EXPECT_EQ(image.At(0, 0), (Color{100, 5, 10}));
  image.Blend(0, 0, kRed, 0);
  EXPECT_EQ(image.At(0, 0), (Color{100, 5, 10}));
  image.Blend(0, 0, kWhite, 1);
  EXPECT_EQ(image.At(0, 0), kWhite);
  image.Blend(1, 0, kWhite, 1);  // Outside: nothing.
}

TEST(Image, PastesWhatFits) {
  Image small(3, 3);
  small.Fill({0, 0, 3, 3}, kRed);
  Image image(10, 8);
  image.Paste(small, 8, -1);
  EXPECT_EQ(Count(image, kRed), 4);
  EXPECT_EQ(image.At(9, 1), kRed);
  image.Paste(small, 20, 20);
  image.Paste(small, -3, 0);
  EXPECT_EQ(Count(image, kRed), 4);
}

}  // namespace
}  // namespace sidestep::render::image_test
