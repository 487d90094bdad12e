#include "sidestep/hardware/remote_frames.h"

#include <chrono>
#include <utility>

#include "sidestep/robot/robot_error.h"

namespace sidestep::hardware {
namespace {

namespace fci = robot::fci;

constexpr std::chrono::seconds kFrameConnectTime(10);
// A picture is drawn meanwhile, perhaps on a machine that has much else to do; time stands still.
constexpr std::chrono::seconds kFrameReplyTime(600);

}  // namespace

RemoteFrames::RemoteFrames(const std::string& address)
    : stream_(fci::ByteStream::Connect(address, fci::kFramePort, kFrameConnectTime)),
      next_due_(Ask(fci::FrameQuestion::kWhen).next_due) {}

std::optional<robot::Frame> RemoteFrames::Read(EpisodeTime) {
  try {
    fci::FrameReply reply = Ask(fci::FrameQuestion::kRead);
    next_due_ = reply.next_due;
    return std::move(reply.frame);
  } catch (const fci::LinkError& error) {
    throw robot::RobotError(std::string("the camera of the robot server: ") + error.what());
  }
}

fci::FrameReply RemoteFrames::Ask(fci::FrameQuestion question) {
  stream_.Send({static_cast<std::uint8_t>(question)});
  const auto until = std::chrono::steady_clock::now() + kFrameReplyTime;
  for (;;) {
    if (auto reply = fci::TakeFrameReply(&received_)) return std::move(*reply);
    if (stream_.Receive(&received_)) continue;
    const auto left = until - std::chrono::steady_clock::now();
    if (left.count() <= 0) throw fci::LinkError("it does not answer");
    fci::WaitToRead({stream_.fd()}, std::chrono::duration_cast<std::chrono::microseconds>(left));
  }
}

}  // namespace sidestep::hardware
