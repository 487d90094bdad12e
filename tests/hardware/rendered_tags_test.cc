// Tags in rendered pictures, found and located, against the truth of the simulator.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "sidestep/core/random.h"
#include "sidestep/hardware/tag_detector.h"
#include "tests/hardware/posed_tags.h"

namespace sidestep {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const Eigen::Vector3d kBox(0.20, 0.25, 0.35);
constexpr const char* kAllFaces =
    "[{face: +x, id: 0, size_m: 0.16}, {face: -x, id: 1, size_m: 0.16}, {face: +y, id: 2, size_m: "
    "0.16}, {face: -y, id: 3, size_m: 0.16}, {face: +z, id: 4, size_m: 0.16}]";

Pose Turned(double yaw_rad, double pitch_rad, const Eigen::Vector3d& p_CO) {
  const Eigen::Quaterniond R(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()));
  // A box that stands upright before a camera, whose y points down.
  const Eigen::Quaterniond upright(Eigen::AngleAxisd(90 * kDegree, Eigen::Vector3d::UnitX()));
  return {upright * R, p_CO};
}

class RenderedTags : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hardware::CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }
};

TEST_F(RenderedTags, AreFoundWhereTheWorldHasThem) {
  const std::vector<Pose> poses = {Turned(0.5, 0.3, {0, 0, 1}), Turned(2.2, 0.2, {0.3, -0.1, 1.4}),
                                   Turned(-2.5, 0.4, {-0.4, 0.2, 1.4})};
  PosedTags scene(poses, kBox, kAllFaces, ", distortion: [0.1, -0.2, 0.001, -0.001, 0.05]");
  hardware::TagDetector detector;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const robot::Frame frame = scene.Take();
    const auto pose = hardware::LocateBody(frame.camera, scene.body(), detector.Detect(frame.image),
                                           hardware::kEdgeSigma_px);
    ASSERT_TRUE(pose) << i;
    EXPECT_GE(pose->num_tags, 2) << i;
    EXPECT_LT(pose->reprojection_px, 0.3) << i;
    const Eigen::Vector3d error = pose->X_CO.translation() - scene.X_CO().translation();
    EXPECT_LT(error.norm(), 0.003) << i << ": " << error.transpose();
    EXPECT_LT(pose->X_CO.rotation().angularDistance(scene.X_CO().rotation()), 0.3 * kDegree) << i;
  }
}

TEST_F(RenderedTags, AreTheSameToTheBitEachTime) {
  const std::vector<Pose> poses = {Turned(0.5, 0.3, {0, 0, 1})};
  const std::string small = ", width: 320, height: 180";
  PosedTags one(poses, kBox, kAllFaces, small), other(poses, kBox, kAllFaces, small);
  const robot::Frame frame = one.Take();
  EXPECT_EQ(frame.image, other.Take().image) << "though both are there at once";
}

// Without noise and blur, a frontal face is as bright as its paint.
TEST_F(RenderedTags, HaveTheNoiseThatIsAskedFor) {
  const std::vector<Pose> poses = {Turned(-90 * kDegree, 0, {0, 0, 0.6})};
  const std::string small = ", width: 160, height: 90";
  PosedTags clean(poses, kBox, kAllFaces, small + ", grey_noise: 0");
  PosedTags noisy(poses, kBox, kAllFaces, small + ", grey_noise: 4");
  const robot::GreyImage truth = clean.Take().image, seen = noisy.Take().image;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const double off = static_cast<double>(seen.pixels[i]) - static_cast<double>(truth.pixels[i]);
    sum += off;
    squares += off * off;
  }
  const auto count = static_cast<double>(truth.pixels.size());
  // Rounding adds 1/12 to each variance, and takes as much of the truth's.
  EXPECT_NEAR(sum / count, 0, 4 * 4 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), std::sqrt(16 + 1.0 / 6), 0.1);
}

}  // namespace
}  // namespace sidestep
