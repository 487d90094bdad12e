#include "sidestep/sim/fci/server.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace sidestep::sim::fci {
namespace {

using robot::fci::CommandLink;
using robot::fci::DatagramPort;
using robot::fci::Message;
using robot::fci::RobotCommand;
using std::chrono::microseconds;
using Clock = std::chrono::steady_clock;

constexpr microseconds kMillisecond(1000);
constexpr microseconds kAskAgain(50000);  // how long to wait without a look at `stop`

// One client, from its Connect to its end.
class Session {
 public:
  /// @param frames null: nothing is shown.
  /// @param turn_away the clients that wait at `door`.
  Session(SimulatedPanda& panda, const ServerOptions& options, FrameServer* frames,
          CommandLink link, int door, std::function<void()> turn_away)
      : panda_(panda),
        options_(options),
        frames_(frames),
        link_(std::move(link)),
        states_(options.address),
        door_(door),
        turn_away_(std::move(turn_away)) {}

  /// @return an empty text, or why the client was not taken.
  std::string Connect(const std::function<bool()>& stop);
  void Run(const std::function<bool()>& stop);

 private:
  void HandleRequests();
  void TurnAwayOthers();
  bool SendState();
  void SendReplies();
  std::optional<RobotCommand> ReceiveAnswer();
  std::optional<RobotCommand> AwaitAnswer(Clock::time_point until);
  void StepLocked();
  void StepByTheWall();
  microseconds PatienceBeforeTheFirst();

  SimulatedPanda& panda_;
  const ServerOptions& options_;
  FrameServer* const frames_;
  CommandLink link_;
  DatagramPort states_;
  int door_;
  std::function<void()> turn_away_;
  std::uint64_t state_id_ = 0;  // of the latest state sent
  bool answered_last_ = true;
  int unanswered_ = 0;  // states of a motion before its first command
  Clock::time_point next_tick_ = Clock::now(), motion_since_ = Clock::now();
};

std::string Session::Connect(const std::function<bool()>& stop) {
  std::optional<Message> request;
  while (!(request = link_.Receive())) {
    if (stop()) return "";
    robot::fci::WaitToRead({link_.fd()}, kAskAgain);
  }
  const auto size = robot::fci::PayloadSize(robot::fci::Request::kConnect);
  if (request->request != robot::fci::Request::kConnect || request->payload.size() != size) {
    return "it did not begin with Connect";
  }
  const auto wanted = robot::fci::FromBytes<robot::fci::ConnectRequest>(request->payload);
  const bool fits = wanted.version == options_.version;
  const std::uint8_t status =
      fits ? robot::fci::status::kSuccess : robot::fci::status::kIncompatibleLibraryVersion;
  link_.Send({request->request, request->id, robot::fci::ConnectReply(status, options_.version)});
  if (!fits) {
    return "it speaks version " + std::to_string(wanted.version) + ", not " +
           std::to_string(options_.version);
  }
  states_.SetPeer(link_.peer_address(), wanted.udp_port);
  return "";
}

void Session::HandleRequests() {
  if (frames_ != nullptr) frames_->Answer();
  while (const auto request = link_.Receive()) {
    const auto reply = panda_.Handle(*request);
    if (reply) link_.Send(*reply);
    if (!panda_.awaits_first_command()) continue;
    unanswered_ = 0;
    answered_last_ = true;
    motion_since_ = Clock::now();
  }
}

// False where the network loses it.
bool Session::SendState() {
  if (panda_.loses_states()) return false;
  // A request may have changed the state since it was sent: it has a new one's number then.
  if (panda_.message_id() == state_id_) panda_.NumberAnew();
  const robot::fci::RobotState state = panda_.State();
  state_id_ = state.message_id;
  states_.Send(robot::fci::Encode(state));
  return true;
}

void Session::SendReplies() {
  for (const Message& reply : panda_.TakeReplies()) link_.Send(reply);
}

// The latest command that is in time, of all that have arrived.
std::optional<RobotCommand> Session::ReceiveAnswer() {
  std::optional<RobotCommand> answer;
  while (const auto bytes = states_.Receive(robot::fci::kRobotCommandSize)) {
    const RobotCommand command = robot::fci::DecodeRobotCommand(*bytes);
    if (PacketLoss::IsInTime(command.message_id, state_id_)) answer = command;
  }
  return answer;
}

// Meanwhile requests are answered; one of them may end the motion.
std::optional<RobotCommand> Session::AwaitAnswer(Clock::time_point until) {
  for (;;) {
    HandleRequests();
    if (!panda_.awaits_command()) return std::nullopt;
    if (auto answer = ReceiveAnswer()) return answer;
    const auto left = std::chrono::duration_cast<microseconds>(until - Clock::now());
    if (left.count() <= 0) return std::nullopt;
    std::vector<int> descriptors = {link_.fd(), states_.fd()};
    if (frames_ != nullptr) {
      for (const int descriptor : frames_->descriptors()) descriptors.push_back(descriptor);
    }
    robot::fci::WaitToRead(descriptors, left);
  }
}

// libfranka reads two states of a new motion before it answers one. The second one follows soon;
// more would be in the way of a client that is only slow, so they take ever longer to come.
microseconds Session::PatienceBeforeTheFirst() {
  constexpr microseconds kFirst(2000), kLongest(200000);
  return std::min(kLongest, kFirst * (1 << std::min(5 * unanswered_++, 20)));
}

void Session::StepLocked() {
  if (panda_.is_stopping()) {
    // A stop is over before anything else is heard or seen: what a client finds after it does not
    // depend on when it looks.
    while (panda_.is_stopping()) panda_.Tick(std::nullopt);
    return;
  }
  if (!panda_.awaits_command()) {
    robot::fci::WaitToRead({link_.fd()}, kMillisecond);
    HandleRequests();
    if (!panda_.awaits_command()) panda_.Tick(std::nullopt);
    return;
  }
  const bool is_first = panda_.awaits_first_command();
  const auto grace = microseconds(static_cast<std::int64_t>(options_.grace_s * 1e6));
  const microseconds patience =
      is_first ? PatienceBeforeTheFirst() : (answered_last_ ? grace : kMillisecond);
  const auto answer = AwaitAnswer(Clock::now() + patience);
  if (!panda_.awaits_command()) return;  // a request has ended it
  if (!is_first) answered_last_ = answer.has_value();
  if (is_first && !answer && Clock::now() - motion_since_ > grace + kMillisecond) {
    panda_.LoseClient();
  }
  panda_.Tick(answer);
}

void Session::StepByTheWall() {
  next_tick_ = std::max(next_tick_ + kMillisecond, Clock::now());
  std::optional<RobotCommand> answer;
  for (;;) {
    HandleRequests();
    if (!answer) answer = ReceiveAnswer();
    const auto left = std::chrono::duration_cast<microseconds>(next_tick_ - Clock::now());
    if (left.count() <= 0) break;
    robot::fci::WaitToRead({link_.fd(), states_.fd()}, left);
  }
  if (!answer) answer = ReceiveAnswer();
  constexpr std::chrono::seconds kLongest(1);
  if (panda_.awaits_first_command() && !answer && Clock::now() - motion_since_ > kLongest) {
    panda_.LoseClient();
  }
  panda_.Tick(answer);
}

// Somebody waits: who had gone by the time that he came is noticed first.
void Session::TurnAwayOthers() {
  if (!robot::fci::WaitToRead({door_}, microseconds(0))) return;
  HandleRequests();
  turn_away_();
}

void Session::Run(const std::function<bool()>& stop) {
  auto asked = Clock::now();
  for (;;) {
    if (Clock::now() - asked > kAskAgain) {
      if (stop()) return;
      TurnAwayOthers();
      asked = Clock::now();
    }
    if (panda_.TakeLinkCut()) throw robot::fci::LinkClosed("the network is cut");
    HandleRequests();
    const bool is_sent = SendState();
    if (is_sent) SendReplies();
    if (options_.clock == ServerClock::kWall) {
      StepByTheWall();
    } else if (is_sent) {
      StepLocked();
    } else {
      panda_.Tick(std::nullopt);
    }
  }
}

}  // namespace

Server::Server(SimulatedPanda* panda, const ServerOptions& options)
    : panda_(*panda), options_(options), listener_(options.address, robot::fci::kCommandPort) {}

void Server::Tell(const std::string& what) const {
  if (tell_) tell_(what);
}

void Server::Serve(CommandLink link, const std::function<bool()>& stop) {
  Tell("connected from " + link.peer_address());
  try {
    Session session(panda_, options_, frames_, std::move(link), listener_.fd(),
                    [this] { TurnAway(); });
    const std::string refusal = session.Connect(stop);
    if (!refusal.empty()) {
      Tell("client refused: " + refusal);
      return;
    }
    panda_.BeginAnew();
    if (frames_ != nullptr) frames_->SendAway();
    session.Run(stop);
  } catch (const robot::fci::LinkError& error) {
    Tell(std::string("disconnected: ") + error.what());
  }
  // The arm comes to rest without a client, too.
  panda_.LoseClient();
  while (panda_.is_stopping()) panda_.Tick(std::nullopt);
  panda_.TakeReplies();
}

// The robot has one client at a time.
void Server::TurnAway() {
  while (const auto link = listener_.Accept()) {
    Tell("client refused: " + link->peer_address() + " comes while another one is connected");
  }
}

// The robot's clock goes on without a client, too: a stop that is pressed is let go.
std::optional<CommandLink> Server::AwaitClient() {
  const auto begin = Clock::now();
  for (std::int64_t ticks = 0; Clock::now() - begin < kAskAgain;) {
    if (robot::fci::WaitToRead({listener_.fd()}, kMillisecond)) {
      auto stream = listener_.Accept();
      if (!stream) return std::nullopt;
      return CommandLink(std::move(*stream));
    }
    for (; ticks < (Clock::now() - begin) / kMillisecond; ++ticks) panda_.Tick(std::nullopt);
  }
  return std::nullopt;
}

void Server::Run(const std::function<bool()>& stop) {
  while (!stop()) {
    auto link = AwaitClient();
    if (!link) continue;
    Serve(std::move(*link), stop);
    if (options_.once) return;
  }
}

}  // namespace sidestep::sim::fci
