#include "sidestep/hardware/fci_client.h"

#include "sidestep/hardware/fci_driver.h"

namespace sidestep::hardware {
namespace {

namespace fci = robot::fci;
using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

// libfranka's: a connection or a reply may take a minute, a state a second.
constexpr std::chrono::seconds kReplyTime(60), kStateTime(1), kConnectTime(10);

FciError Gone(const fci::LinkError& error) {
  return FciError(FciError::Kind::kNetwork, error.what());
}

fci::CommandLink Connect(const std::string& address) {
  try {
    return fci::CommandLink::Connect(address, fci::kCommandPort, kConnectTime);
  } catch (const fci::LinkError& error) {
    throw Gone(error);
  }
}

}  // namespace

FciClient::FciClient(const std::string& address) : link_(Connect(address)), states_("0.0.0.0") {
  const auto id = Send(fci::Request::kConnect,
                       fci::ToBytes(fci::ConnectRequest{fci::kVersion, states_.port()}));
  const fci::Bytes reply = AwaitWelcome(id, address);
  if (reply.size() != 3) throw FciError(FciError::Kind::kNetwork, address + ": is no robot");
  server_version_ = reply[1] + 256 * reply[2];
  if (reply[0] != fci::status::kSuccess) {
    throw FciError(FciError::Kind::kVersion,
                   address + ": the robot speaks version " + std::to_string(server_version_) +
                       " of the protocol, this program " + std::to_string(fci::kVersion));
  }
}

fci::Bytes FciClient::AwaitWelcome(std::uint32_t id, const std::string& address) {
  try {
    return AwaitReply(id);
  } catch (const FciError& error) {
    throw FciError(error.kind(), address + ": " + error.what() +
                                     ": another program may be connected to the robot");
  }
}

std::uint32_t FciClient::Send(fci::Request request, const fci::Bytes& payload) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t id = next_id_++;
  try {
    link_.Send({request, id, payload});
  } catch (const fci::LinkError& error) {
    throw Gone(error);
  }
  return id;
}

// What has come before the end counts: who closes a connection may have said why.
void FciClient::CollectReplies() {
  if (end_) return;
  try {
    while (auto message = link_.Receive()) replies_.emplace(message->id, message->payload);
  } catch (const fci::LinkError& error) {
    end_ = error.what();
  }
}

void FciClient::ThrowIfEnded() const {
  if (end_) throw FciError(FciError::Kind::kNetwork, *end_);
}

std::optional<fci::Bytes> FciClient::FindReply(std::uint32_t id) {
  const std::lock_guard lock(mutex_);
  CollectReplies();
  const auto found = replies_.find(id);
  if (found == replies_.end()) {
    ThrowIfEnded();
    return std::nullopt;
  }
  fci::Bytes payload = std::move(found->second);
  replies_.erase(found);
  if (payload.empty()) throw FciError(FciError::Kind::kNetwork, "an empty reply");
  return payload;
}

fci::Bytes FciClient::AwaitReply(std::uint32_t id) {
  constexpr microseconds kTurn(1000);  // another thread may have taken the reply off the link
  const auto until = Clock::now() + kReplyTime;
  for (;;) {
    if (auto reply = FindReply(id)) return std::move(*reply);
    if (Clock::now() > until) throw FciError(FciError::Kind::kNetwork, "the robot gives no reply");
    fci::WaitToRead({link_.fd()}, kTurn);
  }
}

std::uint8_t FciClient::Ask(fci::Request request, const fci::Bytes& payload) {
  return AwaitReply(Send(request, payload)).front();
}

std::optional<fci::RobotState> FciClient::NewestState() {
  std::optional<fci::RobotState> newest;
  while (const auto bytes = states_.Receive(fci::kRobotStateSize)) {
    const fci::RobotState state = fci::DecodeRobotState(*bytes);
    if (state.message_id <= last_state_id_) continue;
    last_state_id_ = state.message_id;
    newest = state;
  }
  return newest;
}

fci::RobotState FciClient::AwaitState() {
  constexpr microseconds kTurn(10000);  // as often the connection is looked after
  const auto until = Clock::now() + kStateTime;
  for (;;) {
    if (const auto state = NewestState()) return *state;
    {
      const std::lock_guard lock(mutex_);
      CollectReplies();
      ThrowIfEnded();
    }
    if (Clock::now() > until) throw FciError(FciError::Kind::kNetwork, "the robot sends no state");
    fci::WaitToRead({states_.fd()}, kTurn);
  }
}

fci::RobotState FciClient::AwaitFreshState() {
  NewestState();
  return AwaitState();
}

void FciClient::Answer(const fci::RobotCommand& command) { states_.Send(fci::Encode(command)); }

}  // namespace sidestep::hardware
