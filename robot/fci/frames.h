#pragma once

#include <cstdint>
#include <optional>

#include "sidestep/robot/fci/wire.h"
#include "sidestep/robot/frame_source.h"

// How a simulated robot server shows what a camera sees in its world: over a TCP connection of its
// own, one byte a question, one reply to each. No part of Franka's protocol; both ends are this
// program.
namespace sidestep::robot::fci {

inline constexpr std::uint16_t kFramePort = 1339;

enum class FrameQuestion : std::uint8_t {
  kWhen = 1,  ///< when the camera has to be read next
  kRead = 2   ///< the next frame, if it has arrived by now, and when to read then
};

struct FrameReply {
  EpisodeTime next_due;
  std::optional<Frame> frame;
};

Bytes Encode(const FrameReply& reply);

/// Takes a reply off the front of what has been received; nothing as long as it is not whole.
/// @throws LinkError (robot/fci/socket.h) for bytes that are none.
std::optional<FrameReply> TakeFrameReply(Bytes* received);

}  // namespace sidestep::robot::fci
