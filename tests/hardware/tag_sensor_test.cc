// What becomes of pictures that are painted here: tags that face the camera, seen without a world.
#include "sidestep/hardware/tag_sensor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "sidestep/robot/robot_error.h"
#include "tests/hardware/printed_tag.h"

namespace sidestep::hardware::tag_sensor_test {
namespace {

constexpr int kModule_px = 8;     // 1 m away
constexpr double kTag_m = 0.128;  // so a module is 16 mm
constexpr double kPeriod_s = 1.0 / 30;

robot::CameraIntrinsics Camera() {
  return {.width = 320, .height = 240, .fx = 500, .fy = 500, .cx = 159.5, .cy = 119.5};
}

// A tag's id, and the pixel of the upper left corner of its print.
using Picture = std::map<int, std::pair<int, int>>;

class PaintedFrames final : public robot::FrameSource {
 public:
  explicit PaintedFrames(std::vector<Picture> pictures) : pictures_(std::move(pictures)) {}

  EpisodeTime NextDue() const override {
    if (next_ == pictures_.size()) return EpisodeTime(std::numeric_limits<double>::infinity());
    return EpisodeTime(static_cast<double>(next_) * kPeriod_s);
  }
  std::optional<robot::Frame> Read(EpisodeTime now) override {
    if (now < NextDue()) return std::nullopt;
    robot::Frame frame;
    frame.t = NextDue();
    frame.serial = "painted";
    frame.camera = Camera();
    frame.image = Paper(frame.camera.width, frame.camera.height);
    for (const auto& [id, corner] : pictures_[next_]) {
      Print(id, corner.first, corner.second, kModule_px, &frame.image);
    }
    ++next_;
    return frame;
  }

 private:
  std::vector<Picture> pictures_;
  std::size_t next_ = 0;
};

// Of the middle of a tag that is printed there: a module is 8 px and 16 mm.
Eigen::Vector3d PositionOf(int left, int top) {
  const double middle = 5 * kModule_px - 0.5;
  return {(left + middle - 159.5) / 500, (top + middle - 119.5) / 500, 1};
}

TagSensorOptions Options() {
  TagSensorOptions options;
  options.bodies = {{"box", Box{{0.2, 0.2, 0.2}}, {{3, kTag_m, Pose()}}}};
  options.p_WStatic = Eigen::Vector3d(1, 2, 3);
  return options;
}

std::vector<Scan> Scans(std::vector<Picture> pictures, const TagSensorOptions& options) {
  TagSensor sensor(std::make_unique<PaintedFrames>(std::move(pictures)), options);
  std::vector<Scan> scans;
  while (std::isfinite(sensor.NextDue().seconds())) scans.push_back(*sensor.Read(sensor.NextDue()));
  return scans;
}

class TagSensor : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }
};

TEST_F(TagSensor, TellsWhereABodyIsFromTheThirdPictureOn) {
  std::vector<Picture> pictures;
  for (int k = 0; k < 8; ++k) pictures.push_back({{3, {100 + 2 * k, 60}}});
  const std::vector<Scan> scans = Scans(pictures, Options());
  ASSERT_EQ(scans.size(), 8u);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    EXPECT_NEAR(scans[k].t.seconds(), static_cast<double>(k) * kPeriod_s, 1e-12);
    EXPECT_EQ(scans[k].p_CP, Eigen::Vector3d(1, 2, 3)) << "what stands still";
    ASSERT_EQ(scans[k].objects.size(), k < 2 ? 0u : 1u) << k;
    if (k < 2) continue;
    const ObjectObservation& seen = scans[k].objects[0];
    EXPECT_EQ(seen.id, "box");
    EXPECT_EQ(seen.t, scans[k].t);
    const Eigen::Vector3d error =
        seen.X_WO.translation() - PositionOf(100 + 2 * static_cast<int>(k), 60);
    EXPECT_LT(error.head<2>().norm(), 0.001) << error.transpose();
    EXPECT_LT(std::abs(error.z()), 0.01) << error.transpose();
    EXPECT_GT(seen.covariance.diagonal().minCoeff(), 0);
  }
}

TEST_F(TagSensor, SeesFromWhereTheCameraStands) {
  TagSensorOptions options = Options();
  options.X_WC = Pose::FromRollPitchYaw({0.3, -0.2, 0.5}, {1, 2, 3});
  const auto scans = Scans(std::vector<Picture>(4, {{3, {100, 60}}}), options);
  const Eigen::Vector3d error =
      scans.back().objects.at(0).X_WO.translation() - options.X_WC * PositionOf(100, 60);
  EXPECT_LT(error.norm(), 0.01);
}

TEST_F(TagSensor, DoesNotFollowWhatLeapsNorWhatIsGone) {
  std::vector<Picture> pictures(6, {{3, {100, 60}}});
  pictures.push_back({{3, {220, 60}}});  // a mistake: 24 cm in a thirtieth of a second
  pictures.push_back({});
  pictures.push_back({{4, {100, 60}}});  // another one's
  pictures.push_back({{3, {100, 60}}});
  const auto scans = Scans(pictures, Options());
  const std::vector<std::size_t> expected = {0, 0, 1, 1, 1, 1, 0, 0, 0, 1};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(scans[k].objects.size(), expected[k]) << k;
  }
}

TEST_F(TagSensor, NoticesThatItsCameraWasMoved) {
  TagSensorOptions options = Options();
  const Pose X_WO = Pose::Translation(PositionOf(200, 100));
  options.references = {{{"table", Box{{1, 1, 1}}, {{9, kTag_m, Pose()}}}, X_WO}};
  EXPECT_EQ(Scans(std::vector<Picture>(20, {{9, {200, 100}}}), options).size(), 20u);
  EXPECT_EQ(Scans(std::vector<Picture>(20, {{9, {202, 100}}}), options).size(), 20u) << "4 mm";
  EXPECT_EQ(Scans(std::vector<Picture>(4, {{9, {208, 100}}}), options).size(), 4u) << "not long";
  EXPECT_THAT(
      [&] {
        Scans(std::vector<Picture>(5, {{9, {208, 100}}}), options);
      },
      ::testing::ThrowsMessage<robot::RobotError>(::testing::MatchesRegex(
          "the camera painted was moved: it sees 'table' 0.01[0-9] m from where it "
          "stands")));
}

}  // namespace
}  // namespace sidestep::hardware::tag_sensor_test
