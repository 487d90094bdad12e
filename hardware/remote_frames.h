#pragma once

#include <string>

#include "sidestep/robot/fci/frames.h"
#include "sidestep/robot/fci/socket.h"
#include "sidestep/robot/frame_source.h"

namespace sidestep::hardware {

/// The pictures of a camera in the world of a simulated robot server (robot/fci/frames.h), on the
/// clock of that world. In lock-step alone, where a picture is asked for at its time.
class RemoteFrames final : public robot::FrameSource {
 public:
  /// Connects. Whoever drives the robot connects to it before: its world begins with that.
  /// @throws robot::fci::LinkError if nobody shows pictures there.
  explicit RemoteFrames(const std::string& address);

  EpisodeTime NextDue() const override { return next_due_; }
  /// @throws RobotError if the server is gone.
  std::optional<robot::Frame> Read(EpisodeTime now) override;

 private:
  robot::fci::FrameReply Ask(robot::fci::FrameQuestion question);

  robot::fci::ByteStream stream_;
  robot::fci::Bytes received_;
  EpisodeTime next_due_;
};

}  // namespace sidestep::hardware
