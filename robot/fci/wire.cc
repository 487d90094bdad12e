#include "sidestep/robot/fci/wire.h"

#include <bit>
#include <cstring>
#include <iterator>
#include <stdexcept>

namespace sidestep::robot::fci {
namespace {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

// Up to here the plain structs lie as on the wire; what follows is one member that does not.
constexpr std::size_t kStateHead = kRobotStateSize - sizeof(double);
constexpr std::size_t kCommandHead = kRobotCommandSize - sizeof(Joints);

struct RequestFacts {
  const char* name;
  std::size_t payload_size;
};
constexpr std::array<RequestFacts, kNumRequests> kRequests = {{
    {"Connect", sizeof(ConnectRequest)},
    {"Move", sizeof(MoveRequest)},
    {"Stop Move", 0},
    {"Get Cartesian Limit", sizeof(CartesianLimitRequest)},
    {"Set Collision Behavior", sizeof(CollisionBehaviorRequest)},
    {"Set Joint Impedance", sizeof(JointImpedanceRequest)},
    {"Set Cartesian Impedance", sizeof(CartesianImpedanceRequest)},
    {"Set Guiding Mode", sizeof(GuidingModeRequest)},
    {"Set EE to K", sizeof(FrameRequest)},
    {"Set NE to EE", sizeof(FrameRequest)},
    {"Set Load", sizeof(LoadRequest)},
    {"Set Filters", sizeof(FiltersRequest)},
    {"Automatic Error Recovery", 0},
    {"Load Model Library", sizeof(ModelLibraryRequest)},
}};

const RequestFacts& Facts(Request request) {
  return kRequests.at(static_cast<std::size_t>(request));
}

}  // namespace

void CopyExactly(const Bytes& bytes, void* to, std::size_t size) {
  if (bytes.size() != size) throw std::invalid_argument("a message of a wrong size");
  std::memcpy(to, bytes.data(), size);
}

Bytes Encode(const RobotState& state) {
  Bytes bytes(kRobotStateSize);
  std::memcpy(bytes.data(), &state, kStateHead);
  std::memcpy(bytes.data() + kStateHead, &state.success_rate, sizeof(double));
  return bytes;
}

Bytes Encode(const RobotCommand& command) {
  Bytes bytes(kRobotCommandSize);
  std::memcpy(bytes.data(), &command, kCommandHead);
  std::memcpy(bytes.data() + kCommandHead, &command.tau_J_d, sizeof(Joints));
  return bytes;
}

RobotState DecodeRobotState(const Bytes& bytes) {
  if (bytes.size() != kRobotStateSize) throw std::invalid_argument("a state of a wrong size");
  RobotState state{};
  std::memcpy(static_cast<void*>(&state), bytes.data(), kStateHead);
  std::memcpy(&state.success_rate, bytes.data() + kStateHead, sizeof(double));
  return state;
}

RobotCommand DecodeRobotCommand(const Bytes& bytes) {
  if (bytes.size() != kRobotCommandSize) throw std::invalid_argument("a command of a wrong size");
  RobotCommand command{};
  std::memcpy(static_cast<void*>(&command), bytes.data(), kCommandHead);
  std::memcpy(&command.tau_J_d, bytes.data() + kCommandHead, sizeof(Joints));
  return command;
}

std::size_t PayloadSize(Request request) { return Facts(request).payload_size; }
const char* Name(RobotMode mode) {
  constexpr const char* kNames[] = {"other",  "idle",         "move",    "guiding",
                                    "reflex", "user stopped", "recovery"};
  const auto number = static_cast<std::size_t>(mode);
  return kNames[number < std::size(kNames) ? number : 0];
}
const char* Name(Request request) { return Facts(request).name; }

Bytes ConnectReply(std::uint8_t status, std::uint16_t version) {
  return {status, static_cast<std::uint8_t>(version & 0xff),
          static_cast<std::uint8_t>(version >> 8)};
}

Bytes NoCartesianLimit(std::uint8_t status) {
  constexpr std::size_t kSizeFrameActive = (3 + 16) * sizeof(double) + 1;
  Bytes payload(1 + kSizeFrameActive, 0);
  payload[0] = status;
  return payload;
}

}  // namespace sidestep::robot::fci
