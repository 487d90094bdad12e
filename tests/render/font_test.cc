#include "sidestep/render/font.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace sidestep::render::font_test {
namespace {

constexpr Color kWhite = {255, 255, 255};

// The rows and columns that hold ink: first and last of each; -1 if none does.
struct Ink {
  int left = -1, right = -1, top = -1, bottom = -1;
};

Ink FindInk(const Image& image) {
  Ink ink;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.At(x, y).r < 64) continue;
      if (ink.top < 0) ink.top = y;
      ink.bottom = y;
      if (ink.left < 0 || x < ink.left) ink.left = x;
      if (x > ink.right) ink.right = x;
    }
  }
  return ink;
}

TEST(Font, KeepsWholeLettersWithinTheirLine) {
  const GlContext gl;
  const Font font(gl);
  Image image(300, 60);
  const double end = font.Draw(image, 10, 12, 24, kWhite, "|Agjpy(9)|");
  const Ink ink = FindInk(image);
  EXPECT_GE(ink.left, 10);
  EXPECT_LE(ink.right, end);
  EXPECT_GE(ink.top, 12);
  EXPECT_LT(ink.bottom, 12 + 24);
  EXPECT_GT(ink.bottom - ink.top, 16);  // From the bar's top to its foot, and nothing cut off:
  EXPECT_GT(ink.top, 12);               // there is room above
  EXPECT_LT(ink.bottom, 12 + 24 - 1);   // and below.
}

TEST(Font, IsAsWideAsItSaysAndScalesWithTheLine) {
  const GlContext gl;
  const Font font(gl);
  Image image(400, 60);
  const std::string text = "clearance 31 mm";
  EXPECT_NEAR(font.Draw(image, 5, 5, 20, kWhite, text) - 5, font.Width(text, 20), 1e-9);
  EXPECT_NEAR(font.Width(text, 40), 2 * font.Width(text, 20), 1e-9);
  EXPECT_GT(font.Width("WW", 20), font.Width("ii", 20));
  EXPECT_EQ(font.Width("", 20), 0);
}

TEST(Font, SmoothsEdges) {
  const GlContext gl;
  const Font font(gl);
  Image image(200, 40);
  font.Draw(image, 5, 5, 22, kWhite, "smooth");
  std::set<int> levels;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) levels.insert(image.At(x, y).r);
  }
  EXPECT_TRUE(levels.contains(0));
  EXPECT_GT(*levels.rbegin(), 240);
  EXPECT_GT(levels.size(), 8u);
}

TEST(Font, DrawsEveryPrintableLetterDifferentlyAndOthersAsQuestionMarks) {
  const GlContext gl;
  const Font font(gl);
  const auto draw = [&](const std::string& text) {
    Image image(40, 40);
    font.Draw(image, 4, 4, 30, kWhite, text);
    return std::string(reinterpret_cast<const char*>(image.row(0)), 40 * 40 * 3);
  };
  std::set<std::string> pictures;
  for (char letter = '!'; letter <= '~'; ++letter) pictures.insert(draw({letter}));
  EXPECT_EQ(pictures.size(), 94u);
  EXPECT_FALSE(pictures.contains(draw(" ")));
  EXPECT_EQ(draw("\x07"), draw("?"));
  EXPECT_EQ(draw("\xe9"), draw("?"));
  EXPECT_EQ(draw("\xE2\x82\xAC"), draw("?")) << "one character, one mark";
  EXPECT_EQ(font.Width("caf\xC3\xA9", 30), font.Width("caf?", 30));
}

TEST(Font, KnowsWhichTextsItShowsWhole) {
  EXPECT_TRUE(Font::HasAll("Execute and update ~ 1"));
  EXPECT_FALSE(Font::HasAll("caf\xC3\xA9"));
  EXPECT_FALSE(Font::HasAll("caf\xE9"));
}

}  // namespace
}  // namespace sidestep::render::font_test
