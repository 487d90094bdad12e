#include "sidestep/render/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/render/video_writer.h"
#include "tests/render/sample_recording.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::render::video_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class VideoFile : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::ptrdiff_t NumFiles() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()), {});
  }

 private:
  const TemporaryFolder folder_;
};

// What a command prints; fails the test if the command fails.
std::string OutputOf(const std::string& command) {
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "";
  std::string output;
  char buffer[4096];
  std::size_t size = 0;
  while ((size = std::fread(buffer, 1, sizeof buffer, pipe)) > 0) output.append(buffer, size);
  EXPECT_EQ(pclose(pipe), 0) << command;
  return output;
}

// A picture that changes from frame to frame, of broad shapes so that compression keeps them.
Image TestPicture(int width, int height, int frame) {
  Image image(width, height);
  image.Fill({0, 0, width, height}, {30, 60, 90});
  image.Fill({width / 8 + 4 * frame, height / 4, width / 4, height / 2}, {220, 180, 40});
  image.Fill({width / 2, height / 2, width / 2, height / 2}, {200, 30, 30});
  return image;
}

void WriteTestVideo(const std::string& path) {
  VideoWriter video(path, 320, 180, 25);
  for (int i = 0; i < 40; ++i) video.Add(TestPicture(320, 180, i));
  video.Finish();
}

// The frames of a file as ffmpeg decodes them: RGB, one after another.
std::string Decode(const std::string& path) {
  return OutputOf("ffmpeg -v error -i " + path + " -f rawvideo -pix_fmt rgb24 -");
}

TEST_F(VideoFile, IsPlainH264ThatPlayersUnderstand) {
  WriteTestVideo(Path("a.mp4"));
  const auto facts = nlohmann::json::parse(OutputOf(
      "ffprobe -v error -count_frames -show_streams -show_format -of json " + Path("a.mp4")));
  ASSERT_EQ(facts["streams"].size(), 1u);
  const auto& stream = facts["streams"][0];
  EXPECT_EQ(stream["codec_name"], "h264");
  EXPECT_EQ(stream["pix_fmt"], "yuv420p");
  EXPECT_EQ(stream["width"], 320);
  EXPECT_EQ(stream["height"], 180);
  EXPECT_EQ(stream["avg_frame_rate"], "25/1");
  EXPECT_EQ(stream["nb_read_frames"], "40");
  EXPECT_EQ(stream["color_space"], "bt709");
  EXPECT_NEAR(std::stod(stream["duration"].get<std::string>()), 1.6, 1e-3);
  EXPECT_THAT(facts["format"]["format_name"].get<std::string>(), HasSubstr("mp4"));
  const std::string bytes = BytesOf(Path("a.mp4"));
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "the index must come first";
}

TEST_F(VideoFile, ShowsTheFramesUprightAndInTheirColours) {
  WriteTestVideo(Path("a.mp4"));
  const std::string frames = Decode(Path("a.mp4"));
  constexpr std::size_t kFrameBytes = 320 * 180 * 3;
  ASSERT_EQ(frames.size(), 40 * kFrameBytes);
  for (const int frame : {0, 20, 39}) {
    const Image expected = TestPicture(320, 180, frame);
    double error = 0;
    for (std::size_t i = 0; i < kFrameBytes; ++i) {
      const auto decoded =
          static_cast<unsigned char>(frames[static_cast<std::size_t>(frame) * kFrameBytes + i]);
      error += std::abs(decoded - expected.row(0)[i]);
    }
    EXPECT_LT(error / kFrameBytes, 3) << "frame " << frame;
  }
}

TEST_F(VideoFile, HasEqualBytesForEqualFrames) {
  WriteTestVideo(Path("a.mp4"));
  WriteTestVideo(Path("b.mp4"));
  EXPECT_EQ(BytesOf(Path("a.mp4")), BytesOf(Path("b.mp4")));
}

TEST_F(VideoFile, AppearsOnlyWhenItIsFinished) {
  {
    VideoWriter video(Path("a.mp4"), 320, 180, 25);
    video.Add(TestPicture(320, 180, 0));
    EXPECT_FALSE(std::filesystem::exists(Path("a.mp4")));
  }
  EXPECT_EQ(NumFiles(), 0);
  WriteTestVideo(Path("a.mp4"));
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(VideoFile, IsRefusedInOneLineWhereItCannotBeMade) {
  const auto refusal = [](const std::string& path, int width, int height, int rate) {
    try {
      VideoWriter(path, width, height, rate);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(Path("a.mp4"), 321, 180, 25),
            "--size: 321x180: width and height must be even and positive");
  EXPECT_EQ(refusal(Path("a.mp4"), 320, 0, 25),
            "--size: 320x0: width and height must be even and positive");
  EXPECT_EQ(refusal(Path("a.mp4"), 320, 180, 0), "--fps: must be 1 to 240, is 0");
  EXPECT_EQ(refusal(Path("a.avi"), 320, 180, 25),
            Path("a.avi") + ": a video needs a name that ends in .mp4");
  EXPECT_EQ(refusal(Path("absent/a.mp4"), 320, 180, 25),
            Path("absent/a.mp4") + ": cannot be written: No such file or directory");
  EXPECT_EQ(NumFiles(), 0);
}

TEST_F(VideoFile, ForWhichThereIsNoRoomIsRefusedWithItsReason) {
  std::filesystem::create_symlink("/dev/full", Path("full.mp4"));
  try {
    WriteTestVideo(Path("full.mp4"));
    ADD_FAILURE() << "was written";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), Path("full.mp4") + ": cannot be written: No space left on device");
  }
}

TEST_F(VideoFile, PngHoldsEveryPixelExactly) {
  const Image image = TestPicture(321, 181, 3);
  WritePng(image, Path("a.png"));
  WritePng(image, Path("b.png"));
  EXPECT_EQ(BytesOf(Path("a.png")), BytesOf(Path("b.png")));
  EXPECT_THAT(BytesOf(Path("a.png")), StartsWith("\x89PNG\r\n"));
  const std::string pixels = Decode(Path("a.png"));
  EXPECT_EQ(pixels, std::string(reinterpret_cast<const char*>(image.row(0)), 321 * 181 * 3));
  EXPECT_THROW(WritePng(image, Path("absent/a.png")), InputError);
  EXPECT_THROW(WritePng(image, Path("a.jpg")), InputError);
  EXPECT_EQ(NumFiles(), 2);
}

// The whole way, from recordings to files.
class ComparisonVideo : public VideoFile {
 protected:
  static PictureOptions Small() {
    PictureOptions options;
    options.width = 320;
    options.height = 180;
    return options;
  }
  const std::vector<NamedRecording> traces_ = {{"sample", MakeSampleRecording({})}};
};

TEST_F(ComparisonVideo, IsTheSameFileEachTimeAndLastsAsLongAsTheEpisodeAndASecond) {
  const GlContext gl;
  for (const char* const name : {"a.mp4", "b.mp4"}) {
    Comparison comparison(gl, traces_, Small());
    EXPECT_EQ(RenderVideo(comparison, Path(name), {.frames_per_second = 10}, nullptr), 30);
  }
  EXPECT_EQ(BytesOf(Path("a.mp4")), BytesOf(Path("b.mp4")));
  EXPECT_EQ(Decode(Path("a.mp4")).size(), 30u * 320 * 180 * 3);
}

TEST_F(ComparisonVideo, PlaysSlowerOrFasterAsAsked) {
  const GlContext gl;
  Comparison comparison(gl, traces_, Small());
  const VideoOptions fast = {.frames_per_second = 10, .playback_speed = 2};
  EXPECT_EQ(RenderVideo(comparison, Path("a.mp4"), fast, nullptr), 20);
  for (const double speed : {0.0, -1.0, std::nan("")}) {
    const VideoOptions bad = {.frames_per_second = 10, .playback_speed = speed};
    EXPECT_THROW(RenderVideo(comparison, Path("b.mp4"), bad, nullptr), InputError);
  }
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(ComparisonVideo, StopsWhenToldAndLeavesNoFile) {
  const GlContext gl;
  Comparison comparison(gl, traces_, Small());
  const auto stop_after_two = [](int done, int) { return done < 2; };
  EXPECT_EQ(RenderVideo(comparison, Path("a.mp4"), {.frames_per_second = 10}, stop_after_two), 2);
  EXPECT_EQ(NumFiles(), 0);
}

TEST_F(ComparisonVideo, StillShowsTheTellingMomentUnlessAsked) {
  const GlContext gl;
  Comparison comparison(gl, traces_, Small());
  RenderStill(comparison, Path("telling.png"), std::nullopt);
  RenderStill(comparison, Path("least.png"), EpisodeTime(1.25));
  RenderStill(comparison, Path("start.png"), EpisodeTime(0));
  EXPECT_EQ(BytesOf(Path("telling.png")), BytesOf(Path("least.png")));
  EXPECT_NE(BytesOf(Path("telling.png")), BytesOf(Path("start.png")));
}

}  // namespace
}  // namespace sidestep::render::video_test
