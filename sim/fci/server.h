#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "sidestep/robot/fci/socket.h"
#include "sidestep/sim/fci/frame_server.h"
#include "sidestep/sim/fci/simulated_panda.h"

namespace sidestep::sim::fci {

enum class ServerClock : std::uint8_t {
  /// A state is sent when the last one has been answered: nothing is ever late, a motion runs as
  /// fast as the two programs can, and the same commands give the same bits.
  kLockStep,
  kWall,  ///< a state each millisecond, as the robot does
};

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< its port is the protocol's, 1337
  ServerClock clock = ServerClock::kLockStep;
  double grace_s = 10;  ///< lock-step: an answer that takes longer is lost, as are those after it
  bool once = false;    ///< ends with the first client
  std::uint16_t version = robot::fci::kVersion;
};

/// Puts a simulated Panda on the network: one client after another, as the robot has it; who comes
/// while one is there is turned away.
class Server {
 public:
  /// Takes the port. @param panda must outlive this.
  /// @throws robot::fci::LinkError if the address is not this machine's or the port is taken.
  Server(SimulatedPanda* panda, const ServerOptions& options);

  void TellWith(std::function<void(const std::string&)> tell) { tell_ = std::move(tell); }

  /// Shows what a camera sees as well. In lock-step alone: to take a picture takes longer than a
  /// tick. @param frames must outlive this.
  void Show(FrameServer* frames) { frames_ = frames; }

  /// Serves until `stop` is true, which is asked every 50 ms or so, or after the first client if
  /// options say so. @throws SimulationError.
  void Run(const std::function<bool()>& stop);

 private:
  void Serve(robot::fci::CommandLink link, const std::function<bool()>& stop);
  void TurnAway();
  std::optional<robot::fci::CommandLink> AwaitClient();
  void Tell(const std::string& what) const;

  SimulatedPanda& panda_;
  ServerOptions options_;
  robot::fci::Listener listener_;
  std::function<void(const std::string&)> tell_;
  FrameServer* frames_ = nullptr;
};

}  // namespace sidestep::sim::fci
