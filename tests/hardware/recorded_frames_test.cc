#include "sidestep/hardware/recorded_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::hardware::recorded_frames_test {
namespace {

robot::Frame SmallFrame(int number) {
  robot::Frame frame;
  frame.t = EpisodeTime(0.1 * number);
  frame.number = number;
  frame.serial = "1234";
  frame.camera = {.width = 3, .height = 2, .fx = 10.5, .fy = 11, .cx = 1, .cy = 0.5};
  frame.camera.distortion = {0.1, -0.2, 0.001, 1e-7, 0};
  frame.image = {3, 2, {10, 0, 255, 13, static_cast<std::uint8_t>(number), 32}};
  return frame;
}

class RecordedFrames : public ::testing::Test {
 protected:
  void Record() const {
    FrameRecorder recorder(folder_.path().string());
    for (const int number : {3, 4, 7}) recorder.Add(SmallFrame(number));
    recorder.Finish();
  }
  hardware::RecordedFrames Open() const {
    return hardware::RecordedFrames(folder_.path().string());
  }

  const TemporaryFolder folder_;
};

TEST_F(RecordedFrames, ArePlayedBackAsTheyWere) {
  Record();
  hardware::RecordedFrames frames = Open();
  EXPECT_EQ(frames.size(), 3u);
  EXPECT_FALSE(frames.Read(EpisodeTime(0.2)));
  for (const int number : {3, 4, 7}) {
    EXPECT_EQ(frames.NextDue(), SmallFrame(number).t);
    const auto frame = frames.Read(frames.NextDue());
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->t, SmallFrame(number).t);
    EXPECT_EQ(frame->number, number);
    EXPECT_EQ(frame->serial, "1234");
    EXPECT_EQ(frame->camera, SmallFrame(number).camera);
    EXPECT_EQ(frame->image, SmallFrame(number).image);
  }
  EXPECT_TRUE(std::isinf(frames.NextDue().seconds()));
  EXPECT_FALSE(frames.Read(EpisodeTime(100)));
}

TEST_F(RecordedFrames, AreOfOneCameraAndInOrder) {
  FrameRecorder recorder(folder_.path().string());
  recorder.Add(SmallFrame(3));
  EXPECT_THROW(recorder.Add(SmallFrame(3)), std::invalid_argument);
  robot::Frame other = SmallFrame(4);
  other.serial = "4321";
  EXPECT_THROW(recorder.Add(other), std::invalid_argument);
}

TEST_F(RecordedFrames, AreRefusedWithFileAndLineWhereTheyAreNone) {
  struct Case {
    const char* file;
    const char* text;
    const char* message;
  };
  const Case cases[] = {
      {"frames.csv", "number,t_s\n3,0.3\n", "frames.csv:1: header: must be number,t_s,file"},
      {"frames.csv", "number,t_s,file\n", "frames.csv: holds no frames"},
      {"frames.csv", "number,t_s,file\n3,0.3,000003.pgm\n4,0.3,000004.pgm\n",
       "frames.csv:3: t_s: must be >= 0 and after the one before"},
      {"frames.csv", "number,t_s,file\n3.5,0.3,000003.pgm\n",
       "frames.csv:2: number: must be a whole number >= 0"},
      {"frames.csv", "number,t_s,file\n3,0.3,../000003.pgm\n",
       "frames.csv:2: file: must be the name of a file in this folder"},
      {"frames.csv", "number,t_s,file\n3,0.3,none.pgm\n", "none.pgm: there is no such file"},
      {"000003.pgm", "P5\n3 2\n255\nabc",
       "000003.pgm: must be a PGM file (P5, 255) of 3 x 2 pixels"},
      {"000003.pgm", "P5\n3 2\n255\nabcdefg",
       "000003.pgm: must be a PGM file (P5, 255) of 3 x 2 pixels"},
      {"camera.yaml", "camera: {serial: a, width: 0}",
       "camera.yaml:1: camera.width: must be from 1 to 8192"},
  };
  for (const Case& one : cases) {
    Record();
    const auto path = folder_.path() / one.file;
    std::ofstream(path) << one.text;
    EXPECT_THAT([&] { Open().Read(EpisodeTime(10)); },
                ::testing::ThrowsMessage<InputError>((folder_.path() / one.message).string()));
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace sidestep::hardware::recorded_frames_test
