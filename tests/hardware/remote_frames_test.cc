// Pictures of a robot server's world, over the loopback: from a camera that paints the time.
#include "sidestep/hardware/remote_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "sidestep/hardware/panda_robot.h"
#include "sidestep/hardware/raw_fci_driver.h"
#include "sidestep/robot/robot_error.h"
#include "tests/hardware/served_panda.h"

namespace sidestep::hardware::remote_frames_test {
namespace {

using ::testing::HasSubstr;

constexpr double kRate_hz = 30;

// A picture every thirtieth of a second, which is there at once.
class PaintedClock final : public robot::FrameSource {
 public:
  explicit PaintedClock(const sim::World& world) : world_(world) {}

  EpisodeTime NextDue() const override { return EpisodeTime(number_ / kRate_hz); }
  std::optional<robot::Frame> Read(EpisodeTime now) override {
    if (now < NextDue()) return std::nullopt;
    robot::Frame frame;
    frame.t = world_.time();
    frame.number = number_++;
    frame.serial = "painted";
    frame.camera = {.width = 40, .height = 30, .fx = 50, .fy = 51, .cx = 19.5, .cy = 14.5};
    frame.camera.distortion = {0.1, -0.2, 0.001, 1e-7, 0};
    frame.image = {40, 30, std::vector<std::uint8_t>(1200)};
    for (std::size_t i = 0; i < 1200; ++i) {
      frame.image.pixels[i] =
          static_cast<std::uint8_t>(7 * i + 13 * static_cast<std::size_t>(number_));
    }
    return frame;
  }

 private:
  const sim::World& world_;
  int number_ = 0;
};

// A Panda whose server shows that, with one that drives it.
struct Scene {
  ServedPanda panda{"", {}, sim::fci::PandaAlone(), [](const sim::World& world) {
                      return std::make_unique<PaintedClock>(world);
                    }};
  std::unique_ptr<PandaRobot> Drive() const {
    return std::make_unique<PandaRobot>(
        std::make_unique<RawFciDriver>(panda.address()), panda.robot(),
        PandaOptions{.safety = {}, .lockstep = true, .stops_at_once = {}});
  }
};

TEST(RemoteFrames, AreThoseOfTheServersWorldAtTheRobotsTimes) {
  const Scene scene;
  const auto robot = scene.Drive();
  RemoteFrames frames(scene.panda.address());
  for (int k = 0; k < 10; ++k) {
    const EpisodeTime due = frames.NextDue();
    EXPECT_NEAR(due.seconds(), k / kRate_hz, 1e-12);
    robot->AdvanceTo(due);
    const std::optional<robot::Frame> frame = frames.Read(due);
    ASSERT_TRUE(frame) << k;
    EXPECT_NEAR(frame->t.seconds(), robot->Read().t.seconds(), 1e-9)
        << "the world's and the robot's";
    EXPECT_EQ(frame->number, k);
    EXPECT_EQ(frame->serial, "painted");
    EXPECT_EQ(frame->camera.distortion[1], -0.2);
    EXPECT_EQ(frame->image.pixels[100], static_cast<std::uint8_t>(700 + 13 * (k + 1)));
    EXPECT_FALSE(frames.Read(due)) << "each but once";
  }
}

TEST(RemoteFrames, BeginAnewWithTheWorld) {
  const Scene scene;
  for (int client = 0; client < 2; ++client) {
    const auto robot = scene.Drive();
    RemoteFrames frames(scene.panda.address());
    robot->AdvanceTo(EpisodeTime(0));
    EXPECT_EQ(frames.Read(EpisodeTime(0)).value().number, 0);
    EXPECT_THROW(RemoteFrames(scene.panda.address()), robot::fci::LinkError)
        << "one viewer at a time";
  }
}

TEST(RemoteFrames, EndWithTheServer) {
  auto scene = std::make_unique<Scene>();
  auto robot = scene->Drive();
  RemoteFrames frames(scene->panda.address());
  robot.reset();
  scene.reset();
  EXPECT_THROW(frames.Read(EpisodeTime(0)), robot::RobotError);
  EXPECT_THROW(RemoteFrames("127.99.98.97"), robot::fci::LinkError) << "nobody is there";
}

TEST(RemoteFrames, AreNotTakenFromAnotherProgram) {
  robot::fci::Bytes garbage(1000, 0x5a);
  EXPECT_THAT(
      [&] { robot::fci::TakeFrameReply(&garbage); },
      ::testing::ThrowsMessage<robot::fci::LinkError>(HasSubstr("the peer does not show frames")));
  robot::fci::Bytes begun = robot::fci::Encode({EpisodeTime(1), std::nullopt});
  begun.pop_back();
  EXPECT_FALSE(robot::fci::TakeFrameReply(&begun)) << "it is not whole";
}

}  // namespace
}  // namespace sidestep::hardware::remote_frames_test
