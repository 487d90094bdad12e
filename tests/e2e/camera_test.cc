// Cameras as a person uses them: where one stands is found from rendered pictures of a tag on a
// hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "sidestep/core/csv.h"
#include "sidestep/core/random.h"
#include "sidestep/hardware/camera_calibration.h"
#include "sidestep/hardware/recorded_frames.h"
#include "sidestep/robot/robot_model.h"
#include "tests/hardware/posed_tags.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const Eigen::Vector3d kPlate(0.20, 0.20, 0.02);

class Calibrate : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hardware::CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }

  // Pictures of a Panda's hand, with a plate that bears a tag, at so many configurations; the
  // robot's own picture is left out.
  void Record(int count) {
    const Pose X_WC = scenarios::PoseOfCamera({1, 0, 1}, {0, 0, 0.5});  // of PosedTags
    Eigen::VectorXd q0(7);
    q0 << 0, -0.3, 0, -2.0, 0, 1.9, 0.8;
    // The tag faces the camera, half a metre before it or more, as the hand is held at q0.
    const Pose X_CT0 = Pose::FromRollPitchYaw({0.2, 0.3, 0.1}, {0, 0, 0.8});
    const Pose X_HT = HandAt(q0).Inverse() * X_WC * X_CT0;
    const Pose X_TO = scenarios::TagPose(kPlate, "+z").Inverse();
    RandomStream random(1, "hands");
    std::vector<Pose> X_CO;
    CsvWriter joints({"number", "q1", "q2", "q3", "q4", "q5", "q6", "q7"});
    while (static_cast<int>(X_CO.size()) < count) {
      Eigen::VectorXd q = q0;
      for (int j = 0; j < 7; ++j) q(j) += random.Uniform(-1, 1) * (j < 4 ? 0.15 : 0.45);
      const Pose X_CT = X_WC.Inverse() * HandAt(q) * X_HT;
      const Eigen::Vector2d at = X_CT.translation().head<2>() / X_CT.translation().z();
      const bool is_in_view = std::abs(at.x()) < 0.45 && std::abs(at.y()) < 0.2;
      if (!is_in_view || X_CT.Rotate(Eigen::Vector3d::UnitZ()).z() < 0.6) continue;
      std::vector<std::string> row = {std::to_string(X_CO.size())};
      for (int j = 0; j < 7; ++j) row.push_back(CsvNumber(q(j)));
      joints.AddRow(row);
      X_CO.push_back(X_CT * X_TO);
    }
    PosedTags scene(X_CO, kPlate, "[{face: +z, id: 5, size_m: 0.16}]",
                    ", distortion: [0.1, -0.2, 0.001, -0.001, 0.05]");
    hardware::FrameRecorder recorder(folder_.path().string());
    for (int i = 0; i < count; ++i) recorder.Add(scene.Take());
    recorder.Finish();
    std::ofstream(folder_.path() / "joints.csv") << joints.text();
    truth_ = scene.X_WC();
  }

  Finished Run(const std::string& tag_id) const {
    return RunProgram({SIDESTEP_PROGRAM, "hardware", "calibrate", "hardware_single_table",
                       "--views", folder_.path().string(), "--tag-id", tag_id, "--tag-size", "0.16",
                       "--out", (folder_.path() / "found.yaml").string()});
  }

  Pose HandAt(const Eigen::VectorXd& q) const { return panda_.ComputeLinkPoses(q).back(); }

  const robot::RobotModel panda_ =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  const TemporaryFolder folder_;
  Pose truth_;
};

TEST_F(Calibrate, FindsWhereARenderedCameraStands) {
  Record(24);
  const Finished finished = Run("5");
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const auto found = hardware::ReadCalibration((folder_.path() / "found.yaml").string());
  EXPECT_EQ(found.serial, "rendered");
  EXPECT_EQ(found.robot, "panda");
  EXPECT_LT((found.X_WC.translation() - truth_.translation()).norm(), 0.002) << finished.out;
  EXPECT_LT(found.X_WC.rotation().angularDistance(truth_.rotation()), 0.1 * kDegree);
  EXPECT_LT(found.held_out_rms_m, 0.002);

  // It was found with another lens than the scenario's camera has, and not for this sensor.
  const auto run = [&](const std::string& seen_by) {
    return RunProgram({SIDESTEP_PROGRAM, "hardware", "run", "hardware_single_table", "--set",
                       "seen_by=" + seen_by, "--calibration",
                       (folder_.path() / "found.yaml").string()});
  };
  EXPECT_EQ(run("camera").err,
            "--calibration: the camera has another lens or picture size than when it was "
            "calibrated\n");
  EXPECT_EQ(run("truth").err,
            "--calibration: is of a camera: the sensor is 'occupancy', not tag_images\n");

  const Finished other = Run("6");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err, "views: show the tag 0 times, needed are 20\n");
}

}  // namespace
}  // namespace sidestep
