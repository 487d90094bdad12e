#include "sidestep/hardware/camera_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "sidestep/core/input_error.h"
#include "sidestep/core/random.h"
#include "tests/support/random_points.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::hardware::camera_calibration_test {
namespace {

using ::testing::ThrowsMessage;

constexpr double kTag_m = 0.1;

robot::CameraIntrinsics Camera() {
  robot::CameraIntrinsics camera = robot::PinholeOf(1280, 720, 1.211);
  camera.distortion = {0.1, -0.2, 0.001, -0.001, 0.05};
  return camera;
}

const Pose kX_WC(Eigen::Quaterniond(0.2, 0.8, -0.5, 0.3), {1.5, 0.4, 0.9});
const Pose kX_HT = Pose::FromRollPitchYaw({0.1, 3.0, 0.4}, {0.01, -0.02, 0.12});

// So many views of a tag that is turned by up to `turn` from facing the camera; its corners are off
// by corner_px, and the hand is where the robot says but for hand_m.
std::vector<HandView> Views(int count, double turn, double corner_px = 0, double hand_m = 0) {
  RandomStream random(1, "views");
  std::vector<HandView> views;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d tilt{random.Uniform(-turn, turn), random.Uniform(-turn, turn),
                               random.Uniform(-turn, turn)};
    const Eigen::Vector3d p_CT{random.Uniform(-0.3, 0.3), random.Uniform(-0.2, 0.2),
                               random.Uniform(0.7, 1.3)};
    const Pose X_CT = Pose::FromRollPitchYaw(tilt, p_CT);
    HandView view;
    const double h = kTag_m / 2;
    const Eigen::Vector3d corners[] = {{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d off{random.Normal(), random.Normal()};
      view.tag.corners_px.col(k) = robot::Project(Camera(), X_CT * corners[k]) + corner_px * off;
    }
    const Eigen::Vector3d off{random.Normal(), random.Normal(), random.Normal()};
    view.X_WH = Pose::Translation(hand_m * off) * kX_WC * X_CT * kX_HT.Inverse();
    views.push_back(view);
  }
  return views;
}

CameraCalibration GoodCalibration() {
  CameraCalibration calibration = CalibrateCamera(Camera(), kTag_m, Views(25, 0.6, 0.1));
  calibration.serial = "1234";
  calibration.robot = "panda";
  calibration.date = "2026-02-28";
  return calibration;
}

class CameraCalibration : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }
};

TEST_F(CameraCalibration, FindsTheCameraAndTheTagExactlyFromExactViews) {
  const auto calibration = CalibrateCamera(Camera(), kTag_m, Views(20, 0.6));
  EXPECT_LT((calibration.X_WC.translation() - kX_WC.translation()).norm(), 1e-6);
  EXPECT_LT(calibration.X_WC.rotation().angularDistance(kX_WC.rotation()), 1e-6);
  EXPECT_LT((calibration.X_HT.translation() - kX_HT.translation()).norm(), 1e-6);
  EXPECT_LT(calibration.reprojection_px, 1e-6);
  EXPECT_LT(calibration.held_out_max_m, 1e-5);
  EXPECT_EQ(calibration.num_views, 15);
  EXPECT_EQ(calibration.num_held_out, 5);
}

TEST_F(CameraCalibration, IsAMillimetreOffWhereCornersAreATenthOfAPixelOff) {
  const auto calibration = CalibrateCamera(Camera(), kTag_m, Views(25, 0.6, 0.1));
  EXPECT_LT((calibration.X_WC.translation() - kX_WC.translation()).norm(), 0.001);
  EXPECT_NEAR(calibration.reprojection_px, 0.1, 0.03);
  EXPECT_FALSE(WhyNotAccepted(calibration));
}

TEST_F(CameraCalibration, IsNotAcceptedWhereTheRobotIsElsewhereThanItSays) {
  const auto why = WhyNotAccepted(CalibrateCamera(Camera(), kTag_m, Views(25, 0.6, 0.1, 0.015)));
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, ::testing::MatchesRegex(".* of position in views that it was not fitted to is "
                                            "[0-9.]+ mm, allowed .*"));
}

TEST_F(CameraCalibration, WantsEnoughViewsThatAreTurnedEnough) {
  EXPECT_THAT([] { CalibrateCamera(Camera(), kTag_m, Views(19, 0.6)); },
              ThrowsMessage<InputError>("views: show the tag 19 times, needed are 20"));
  EXPECT_THAT([] { CalibrateCamera(Camera(), kTag_m, Views(20, 0.05)); },
              ThrowsMessage<InputError>(::testing::MatchesRegex(
                  "views: turn the hand by [0-9]+ degrees about the second axis, needed are 30 "
                  "about two")));
}

TEST_F(CameraCalibration, IsReadBackFromItsFile) {
  const auto written = GoodCalibration();
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "camera.yaml").string();
  std::ofstream(path) << ToYaml(written);
  const auto read = ReadCalibration(path);
  EXPECT_EQ(ToYaml(read), ToYaml(written));
  EXPECT_EQ(read.camera, written.camera);
  EXPECT_LT((read.X_WC.translation() - written.X_WC.translation()).norm(), 1e-12);
}

TEST_F(CameraCalibration, IsRefusedWhereItIsAnotherCamerasOldOrToCome) {
  const auto calibration = GoodCalibration();
  const auto why = [&](const std::string& serial, const robot::CameraIntrinsics& camera,
                       const std::string& today) {
    return WhyNotUsable(calibration, serial, camera, today).value_or("");
  };
  EXPECT_EQ(why("1234", Camera(), "2026-03-30"), "");
  EXPECT_EQ(why("1234", Camera(), "2026-03-31"), "it is 31 days old, allowed 30");
  EXPECT_EQ(why("1234", Camera(), "2026-02-27"),
            "its date 2026-02-28 is to come: today is 2026-02-27");
  EXPECT_EQ(why("4321", Camera(), "2026-03-01"), "it is of the camera 1234, this one is 4321");
  robot::CameraIntrinsics other = Camera();
  other.fx += 1;
  EXPECT_EQ(why("1234", other, "2026-03-01"),
            "the camera has another lens or picture size than when it was calibrated");
}

TEST_F(CameraCalibration, IsRefusedAsAFileThatIsNone) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "camera.yaml").string();
  const std::string good = ToYaml(GoodCalibration());
  const auto expect = [&](const std::string& old_text, const std::string& new_text,
                          const std::string& message) {
    std::string text = good;
    const std::size_t at = text.find(old_text);
    ASSERT_NE(at, std::string::npos) << old_text;
    std::ofstream(path) << text.replace(at, old_text.size(), new_text);
    EXPECT_THAT([&] { ReadCalibration(path); }, ThrowsMessage<InputError>(path + message));
  };
  EXPECT_THROW(ReadCalibration(path), InputError) << "there is none";
  expect("2026-02-28", "2026-02-30", ":4: date: must be YYYY-MM-DD");
  expect("  views: 20", "  views: many", ":8: residuals.views: must be a whole number, is 'many'");
  expect("robot: panda", "robto: panda", ":1: robot: is missing");
}

}  // namespace
}  // namespace sidestep::hardware::camera_calibration_test
