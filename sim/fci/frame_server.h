#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/robot/fci/frames.h"
#include "sidestep/robot/fci/socket.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim::fci {

/// Shows what a camera sees in the world of a robot server (robot/fci/frames.h), to one viewer at a
/// time. A picture is taken when a viewer asks at its time: meanwhile the world has to stand still,
/// as it does in lock-step.
class FrameServer {
 public:
  /// Each viewer has a camera of its own, whose clock begins with the world.
  using MakeCamera = std::function<std::unique_ptr<robot::FrameSource>()>;

  /// Takes the port. @param world must outlive this.
  /// @throws robot::fci::LinkError if it is taken.
  FrameServer(const std::string& address, const World& world, MakeCamera make_camera);

  /// What to wait for: when one of them can be read, Answer.
  std::vector<int> descriptors() const;
  /// Answers what has been asked, takes in who waits, and turns away those who come besides.
  void Answer();
  /// The world begins anew: who looks is sent away.
  void SendAway() { viewer_.reset(); }

 private:
  struct Viewer {
    robot::fci::ByteStream stream;
    std::unique_ptr<robot::FrameSource> camera;
  };
  void AnswerViewer();

  const World& world_;
  MakeCamera make_camera_;
  robot::fci::Listener listener_;
  std::optional<Viewer> viewer_;
};

}  // namespace sidestep::sim::fci
