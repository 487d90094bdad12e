// Cameras as a person uses them: where one stands is found from rendered pictures of a tag on a
// hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "sidestep/core/csv.h"
#include "sidestep/core/random.h"
#include "sidestep/hardware/camera_calibration.h"
#include "sidestep/hardware/recorded_frames.h"
#include "sidestep/robot/robot_model.h"
#include "tests/hardware/own_loopback.h"
#include "tests/hardware/posed_tags.h"
#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::camera_test {
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

// A robot that stands, before a camera that sees a box a metre away.
class LookAround : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hardware::CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }

  // Pictures at 30 Hz of a box like that of the laboratory, in which it drifts.
  void Record() const {
    const std::string pictures = In("pictures");
    std::filesystem::create_directory(pictures);
    constexpr int kCount = 10;
    std::vector<Pose> X_CO;
    for (int k = 0; k < kCount; ++k) {
      X_CO.push_back(Pose::FromRollPitchYaw({1.9, 0.5, 0.2}, {0.01 * k, 0, 1.1}));
    }
    PosedTags scene(X_CO, {0.20, 0.25, 0.35},
                    "[{face: +x, id: 0, size_m: 0.16}, {face: -x, id: 1, size_m: 0.16}, {face: +y, "
                    "id: 2, size_m: 0.16}, {face: -y, id: 3, size_m: 0.16}, {face: +z, id: 4, "
                    "size_m: 0.16}]");
    hardware::FrameRecorder recorder(pictures);
    for (int k = 0; k < kCount; ++k) {
      robot::Frame frame = scene.Take();
      frame.t = EpisodeTime(k / 30.0);
      recorder.Add(frame);
    }
    recorder.Finish();
  }

  std::string In(const std::string& name) const { return (folder_.path() / name).string(); }
  Finished Run(const std::string& command, const std::vector<std::string>& further) const {
    std::vector<std::string> words = {SIDESTEP_PROGRAM, "hardware", command};
    words.insert(words.end(), further.begin(), further.end());
    return RunProgram(words, {"XDG_STATE_HOME=" + In("state")});
  }
  Finished Look(const std::vector<std::string>& further) const {
    std::vector<std::string> words = {"hardware_single_table", "--set",
                                      "seen_by=camera",        "--robot",
                                      hardware::OwnLoopback(), "--dry-run"};
    words.insert(words.end(), further.begin(), further.end());
    return Run("run", words);
  }

  const TemporaryFolder folder_;
};

TEST_F(LookAround, LeavesWhatWasSeenAndPlannedAndTheSameIsFoundAgain) {
  Record();
  Running server({SIDESTEP_PROGRAM, "fci-server", "--address", hardware::OwnLoopback(),
                  "--scenario", "hardware_single_table"});
  ASSERT_TRUE(server.Prints("Ctrl-C ends it"));
  const Finished looked = Look({"--camera", "recorded:" + In("pictures"), "--out", In("look")});
  ASSERT_EQ(looked.exit_code, 0) << looked.err;
  EXPECT_THAT(looked.out,
              ::testing::HasSubstr("pictures         10, something that is followed in 8"))
      << "a track begins with the third";
  EXPECT_THAT(looked.out, ::testing::HasSubstr("none was followed"));
  EXPECT_THAT(server.out(), ::testing::Not(::testing::HasSubstr("motion")));
  for (const char* const file : {"dry_run.mp4", "trace.h5", "result.json", "camera/seen.csv"}) {
    EXPECT_GT(std::filesystem::file_size(folder_.path() / "look" / file), 500u) << file;
  }

  const Finished same = Run("replay", {In("look"), "--out", In("again")});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.out, ::testing::HasSubstr("the same as when they were taken, to the bit"));
  EXPECT_EQ(BytesOf(folder_.path() / "look/dry_run.mp4"),
            BytesOf(folder_.path() / "again/dry_run.mp4"));

  // Another picture in the place of one.
  std::filesystem::copy_file(In("look/camera/000002.pgm"), In("look/camera/000006.pgm"),
                             std::filesystem::copy_options::overwrite_existing);
  const Finished other = Run("replay", {In("look")});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.out,
              ::testing::HasSubstr("something else than when they were taken, from line"));
}

TEST_F(LookAround, IsRefusedInOneLineWhereItCannotBe) {
  const struct {
    std::vector<std::string> arguments;
    std::string says;
  } cases[] = {
      {{"--camera", "film"}, "--camera: must be virtual, server, recorded:DIR or realsense:SERIAL"},
      {{"--camera", "recorded:nowhere"}, "no such file"},
      {{"--camera", "server"},
       "--camera: the server's world stands still as long as its robot does"},
      {{"--camera", "realsense:1234"}, "--camera: "},
  };
  Running server({SIDESTEP_PROGRAM, "fci-server", "--address", hardware::OwnLoopback(),
                  "--scenario", "hardware_single_table"});
  ASSERT_TRUE(server.Prints("Ctrl-C ends it"));
  for (const auto& [arguments, says] : cases) {
    const Finished finished = Look(arguments);
    EXPECT_EQ(finished.exit_code, 2) << says;
    EXPECT_THAT(finished.err, ::testing::HasSubstr(says));
  }
  EXPECT_EQ(Run("replay", {In("nothing")}).exit_code, 2);
  const Finished seen_otherwise =
      Run("run", {"hardware_single_table", "--robot", hardware::OwnLoopback(), "--camera", "server",
                  "--clock", "lockstep"});
  EXPECT_EQ(seen_otherwise.err,
            "--camera: is of a camera: the sensor is 'occupancy', not tag_images\n");
  const Finished wall = Run("run", {"hardware_single_table", "--set", "seen_by=camera", "--robot",
                                    hardware::OwnLoopback(), "--camera", "server"});
  EXPECT_EQ(wall.err, "--camera: the server shows pictures in lock-step alone\n");
}

}  // namespace
}  // namespace sidestep::camera_test
