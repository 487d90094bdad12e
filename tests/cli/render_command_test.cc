#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "sidestep/cli/command.h"
#include "sidestep/core/input_error.h"
#include "sidestep/record/recording_file.h"
#include "tests/render/sample_recording.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::cli {
namespace {

using ::testing::HasSubstr;

class RenderCommand : public ::testing::Test {
 protected:
  void SetUp() override { record::WriteRecording(render::MakeSampleRecording({}), trace_); }
  void TearDown() override { unsetenv("MUJOCO_GL"); }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  // What is wrong with `sidestep render ARGUMENTS`, or "done".
  static std::string Run(const std::string& arguments) {
    CommandLine line;
    AddRenderCommand(line);
    try {
      line.app.parse("render " + arguments);
    } catch (const InputError& error) {
      return error.what();
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return line.exit_code == 0 ? "done" : "exit code " + std::to_string(line.exit_code);
  }

  const TemporaryFolder folder_;
  std::string trace_ = Path("trace.h5");
};

TEST_F(RenderCommand, WritesVideoAndStill) {
  EXPECT_EQ(Run(trace_ + " --out " + Path("a.mp4") + " --still " + Path("a.png") +
                " --size 320x180 --fps 5 --speed 2 --camera from_above --title Sample"),
            "done");
  EXPECT_TRUE(std::filesystem::exists(Path("a.mp4")));
  EXPECT_TRUE(std::filesystem::exists(Path("a.png")));
}

// Whatever looks like a protocol or a date to libavformat is the name of a file.
TEST_F(RenderCommand, TakesEveryNameForAFile) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  for (const std::string name : {"2026-11-27T10:15:00.mp4", "file:x.mp4", "http:x.mp4", "pipe:.mp4",
                                 "caf\xE9.mp4", "UPPER.MP4", "%03d.mp4"}) {
    EXPECT_EQ(Run(trace_ + " --out '" + name + "' --size 64x120 --fps 1"), "done") << name;
    EXPECT_TRUE(std::filesystem::exists(name)) << name;
  }
  std::filesystem::current_path(before);
}

TEST_F(RenderCommand, DrawsAStillOfAnySizeUpToTheEnd) {
  EXPECT_EQ(Run(trace_ + " --still " + Path("a.png") + " --size 321x181 --at 2"), "done");
  EXPECT_TRUE(std::filesystem::exists(Path("a.png")));
}

TEST_F(RenderCommand, SaysWhichNamesItCannotSpell) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(Run(trace_ + " --still " + Path("a.png") + " --title 'caf\xC3\xA9'"), "done");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "'caf\xC3\xA9': pictures have no letters but ASCII's; others show as '?'\n");
}

TEST_F(RenderCommand, SaysInOneLineWhatIsWrong) {
  std::ofstream(Path("cut.h5")) << "sidestep trace 1\n";
  const std::string still = " --still " + Path("a.png");
  const struct {
    std::string arguments, message;
  } cases[] = {
      {trace_, "--out: give --out FILE.mp4, --still FILE.png, or both"},
      {trace_ + " --out " + Path("a.mp4") + " --at 1", "--at: needs --still"},
      {trace_ + still + " --size 1280", "--size: must be WIDTHxHEIGHT in pixels"},
      {trace_ + still + " --size 640x360x2", "--size: must be WIDTHxHEIGHT in pixels"},
      {trace_ + still + " --size 99999x2", "--size: must be WIDTHxHEIGHT in pixels"},
      {trace_ + still + " --out " + Path("a.mp4") + " --size 641x360",
       "--size: a video's width and height must be even, is '641x360'"},
      {trace_ + still + " --size 30x30", "--size: 30x30 is too small for 1 traces"},
      {trace_ + still + " --at -1", "--at: "},
      {trace_ + still + " --at 2.1", "--at: the last episode ends at 2.000 s, before 2.1 s"},
      {trace_ + still + " --fps 0", "--fps: "},
      {trace_ + still + " --speed 0", "--speed: "},
      {trace_ + still + " --camera left", "--camera: 'left' is not in "},
      {trace_ + still + " --title a b", "--title: give one for each of the 1 traces, not 2"},
      {Path("absent.h5") + still, Path("absent.h5") + ": no such file"},
      {Path("cut.h5") + still, Path("cut.h5") + ": is cut off"},
      {Path(".") + still, "is a directory, not a file"},
      {trace_ + " --still " + Path("absent/a.png"), "absent/a.png: cannot be written"},
      {trace_ + " --out " + Path("absent/a.mp4"), "absent/a.mp4: cannot be written"},
      {trace_ + " --still " + Path("a.jpg"), "a.jpg: a picture needs a name that ends in .png"},
      {trace_ + " --still " + Path("a"), "/a: a picture needs a name that ends in .png"},
      {trace_ + " --out " + Path("a.avi"), "a.avi: a video needs a name that ends in .mp4"},
      {trace_ + " --out http://localhost:1/a.mp4",
       "http://localhost:1/a.mp4: cannot be written: No such file"},
  };
  for (const auto& c : cases) {
    const std::string message = Run(c.arguments);
    EXPECT_THAT(message, HasSubstr(c.message)) << c.arguments;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_FALSE(std::filesystem::exists(Path("a.png")));
  EXPECT_FALSE(std::filesystem::exists(Path("a.mp4")));
}

// One from elsewhere, whose model compiles.
TEST_F(RenderCommand, SaysWhichTraceCannotBeDrawn) {
  for (const char* const settings :
       {"<statistic extent='-1'/>", "<statistic extent='0'/>", "<statistic extent='1e300'/>",
        "<statistic extent='1e-300'/>", "<visual><map znear='0'/></visual>",
        "<visual><map znear='-1'/></visual>", "<visual><map zfar='0'/></visual>",
        "<visual><map zfar='-1'/></visual>", "<visual><map znear='10' zfar='1'/></visual>"}) {
    record::Recording altered = render::MakeSampleRecording({});
    altered.model_xml.insert(altered.model_xml.find("<asset>"), settings);
    record::WriteRecording(altered, trace_);
    EXPECT_THAT(Run(trace_ + " --still " + Path("a.png")),
                ::testing::StartsWith(trace_ + ": model_xml: a picture of it would reach from "))
        << settings;
  }
}

TEST_F(RenderCommand, RefusesToDrawWhereTheEnvironmentForbidsIt) {
  setenv("MUJOCO_GL", "disable", 1);
  EXPECT_THAT(Run(trace_ + " --still " + Path("a.png")), HasSubstr("MUJOCO_GL: is 'disable'"));
}

}  // namespace
}  // namespace sidestep::cli
