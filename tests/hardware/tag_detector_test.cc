#include "sidestep/hardware/tag_detector.h"

#include <gtest/gtest.h>

#include "tests/hardware/printed_tag.h"

namespace sidestep::hardware::tag_detector_test {
namespace {

using robot::GreyImage;

class TagDetector : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }
};

TEST_F(TagDetector, ReadsEveryTagThatScenariosKnow) {
  hardware::TagDetector detector;
  for (int id = 0; id < scenarios::kNumTagIds; ++id) {
    GreyImage image = Paper(200, 160);
    Print(id, 40, 20, 10, &image);
    const std::vector<TagDetection> tags = detector.Detect(image);
    ASSERT_EQ(tags.size(), 1u) << id;
    EXPECT_EQ(tags[0].id, id);
    EXPECT_EQ(tags[0].hamming, 0) << id;
  }
}

TEST_F(TagDetector, CountsPixelsFromTheCentreOfTheFirst) {
  hardware::TagDetector detector;
  for (const int shift : {0, 1, 2, 3}) {  // the picture it searches is half as large
    GreyImage image = Paper(240, 200);
    Print(7, 40 + shift, 20 + shift, 12, &image);
    const std::vector<TagDetection> tags = detector.Detect(image);
    ASSERT_EQ(tags.size(), 1u);
    // Its black begins with pixel 52, so its edge is at 51.5.
    const double left = 51.5 + shift, top = 31.5 + shift, edge = 8 * 12;
    Eigen::Matrix<double, 2, 4> corners;
    corners << left, left + edge, left + edge, left, top + edge, top + edge, top, top;
    // Edges that lie just between pixels are found an eighth of one aside.
    EXPECT_LT((tags[0].corners_px - corners).cwiseAbs().maxCoeff(), 0.15)
        << tags[0].corners_px - corners;
  }
}

TEST_F(TagDetector, SaysNothingOfAnIdThatIsThereTwice) {
  hardware::TagDetector detector;
  GreyImage image = Paper(400, 160);
  Print(3, 20, 20, 10, &image);
  Print(3, 160, 20, 10, &image);
  Print(4, 290, 20, 10, &image);
  const std::vector<TagDetection> tags = detector.Detect(image);
  ASSERT_EQ(tags.size(), 1u);
  EXPECT_EQ(tags[0].id, 4);
}

TEST_F(TagDetector, LeavesOutWhatIsTooSmallOrTooFaint) {
  GreyImage image = Paper(200, 160);
  Print(3, 20, 20, 6, &image);
  EXPECT_EQ(hardware::TagDetector({.least_edge_px = 40}).Detect(image).size(), 1u);
  EXPECT_TRUE(hardware::TagDetector({.least_edge_px = 50}).Detect(image).empty());
  EXPECT_TRUE(hardware::TagDetector({.least_margin = 250}).Detect(image).empty());
}

// What the library makes up for what it does not see is wrong by pixels.
TEST_F(TagDetector, LeavesOutWhatThePictureCutsOff) {
  hardware::TagDetector detector;
  constexpr int kModule_px = 10;
  GreyImage whole = Paper(200, 160);
  Print(3, 40, 30, kModule_px, &whole);
  // Its black begins one module after its white rim.
  for (const int cut_px : {0, 40, 44, 46, 48, 50, 52, 54}) {
    GreyImage image = Paper(whole.width - cut_px, whole.height);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) image.At(x, y) = whole.At(x + cut_px, y);
    }
    const double from_rim_px = 40 + kModule_px - 0.5 - cut_px;
    EXPECT_EQ(detector.Detect(image).size(), from_rim_px > 5 ? 1u : 0u) << cut_px;
  }
}

TEST_F(TagDetector, TakesPicturesOfAnySize) {
  hardware::TagDetector detector;
  for (const int size : {0, 1, 2, 31, 32, 33, 47}) {
    EXPECT_TRUE(detector.Detect(Paper(size, size)).empty()) << size;
    EXPECT_TRUE(detector.Detect(Paper(size, 200)).empty()) << size;
  }
}

}  // namespace
}  // namespace sidestep::hardware::tag_detector_test
