#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "sidestep/robot/fci/socket.h"
#include "sidestep/robot/fci/wire.h"

namespace sidestep::hardware {

/// The two channels to a robot that speaks protocol 5: requests and their replies, states and their
/// answers. Requests may come from any thread; states and answers from one.
class FciClient {
 public:
  /// Connects. @throws FciError kNetwork, or kVersion if the robot speaks another version.
  explicit FciClient(const std::string& address);

  int server_version() const { return server_version_; }

  /// Sends a request. @return its id, which the replies have.
  std::uint32_t Send(robot::fci::Request request, const robot::fci::Bytes& payload);
  /// The payload of a reply, its status first, if it has come; each but once.
  std::optional<robot::fci::Bytes> FindReply(std::uint32_t id);
  /// The same; waits for it. @throws FciError kNetwork if the
  /// connection is closed or none comes within a minute.
  robot::fci::Bytes AwaitReply(std::uint32_t id);
  /// Both, for requests with one reply. @return the status.
  std::uint8_t Ask(robot::fci::Request request, const robot::fci::Bytes& payload);

  /// The newest state that is newer than the last; waits for it. @throws FciError kNetwork if the
  /// connection is closed or none comes within a second.
  robot::fci::RobotState AwaitState();
  /// The same, after those that have arrived before now are thrown away.
  robot::fci::RobotState AwaitFreshState();

  void Answer(const robot::fci::RobotCommand& command);

 private:
  robot::fci::Bytes AwaitWelcome(std::uint32_t id, const std::string& address);
  std::optional<robot::fci::RobotState> NewestState();
  void CollectReplies();  // under mutex_, as the next
  void ThrowIfEnded() const;

  robot::fci::CommandLink link_;
  robot::fci::DatagramPort states_;
  int server_version_ = 0;
  std::uint64_t last_state_id_ = 0;

  std::mutex mutex_;  // of all below and the link
  std::uint32_t next_id_ = 0;
  std::multimap<std::uint32_t, robot::fci::Bytes> replies_;
  std::optional<std::string> end_;  ///< why the connection is closed
};

}  // namespace sidestep::hardware
