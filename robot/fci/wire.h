#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

// What goes over the wire between a Franka Emika Panda and its client, protocol version 5 (robot
// system 4.2.1 and later, libfranka 0.9.x). Two channels: commands over TCP, each answered at least
// once, and every millisecond a state over UDP, which the client answers with a command.
//
// The structs here are plain ones, aligned as the compiler likes. On the wire everything is packed
// and little-endian; Encode and Decode go between the two.
//
// Written from the published facts of libfranka-common e6aa0fc and libfranka 0.9.2 (Apache-2.0,
// Franka Emika GmbH; see NOTICE): numbers, sizes, orders; no code of theirs.
namespace sidestep::robot::fci {

inline constexpr std::uint16_t kVersion = 5;
inline constexpr std::uint16_t kCommandPort = 1337;
inline constexpr int kNumJoints = 7;

using Joints = std::array<double, 7>;
using Wrench = std::array<double, 6>;    ///< force [N], torque [N m]
using Matrix4 = std::array<double, 16>;  ///< column by column
using Bytes = std::vector<std::uint8_t>;

enum class RobotMode : std::uint8_t {
  kOther,
  kIdle,
  kMove,
  kGuiding,
  kReflex,
  kUserStopped,
  kRecovery
};
/// "idle", "user stopped", ...
const char* Name(RobotMode mode);

enum class MotionGenerator : std::uint8_t {
  kIdle,
  kJointPosition,
  kJointVelocity,
  kCartesianPosition,
  kCartesianVelocity
};

enum class Controller : std::uint8_t {
  kJointImpedance,
  kCartesianImpedance,
  kExternalTorque,
  kOther  ///< the robot's own: no motion runs
};

/// What the robot tells each millisecond. Of the pairs in elbows, the first is joint 3 [rad], the
/// second the sign of the flip. Units: m, rad, s, N, N m, kg.
struct RobotState {
  std::uint64_t message_id;  ///< the robot's clock [ms]; strictly increases
  Matrix4 O_T_EE, O_T_EE_d, F_T_EE, EE_T_K, F_T_NE, NE_T_EE;
  double m_ee;
  std::array<double, 9> I_ee;
  std::array<double, 3> F_x_Cee;
  double m_load;
  std::array<double, 9> I_load;
  std::array<double, 3> F_x_Cload;
  std::array<double, 2> elbow, elbow_d;
  Joints tau_J, tau_J_d, dtau_J;
  Joints q, q_d, dq, dq_d, ddq_d;
  Joints joint_contact;  ///< 1 where the lower threshold is passed, else 0, as the next three
  Wrench cartesian_contact;
  Joints joint_collision;  ///< the upper threshold
  Wrench cartesian_collision;
  Joints tau_ext_hat_filtered;
  Wrench O_F_ext_hat_K, K_F_ext_hat_K, O_dP_EE_d;
  std::array<double, 3> O_ddP_O;
  std::array<double, 2> elbow_c, delbow_c, ddelbow_c;
  Matrix4 O_T_EE_c;
  Wrench O_dP_EE_c, O_ddP_EE_c;
  Joints theta, dtheta;
  MotionGenerator motion_generator;
  Controller controller;
  std::array<std::uint8_t, 41> errors;         ///< 0 or 1 each, in the order of errors.h
  std::array<std::uint8_t, 41> reflex_reason;  ///< what ended the last motion
  RobotMode robot_mode;
  double success_rate;  ///< of the last 100 commands, those in time; 0 while no motion runs
};
inline constexpr std::size_t kRobotStateSize = 2373;
static_assert(offsetof(RobotState, tau_J) == 1016 && offsetof(RobotState, tau_J_d) == 1072);
static_assert(offsetof(RobotState, q) == 1184 && offsetof(RobotState, q_d) == 1240);
static_assert(offsetof(RobotState, dq) == 1296 && offsetof(RobotState, dq_d) == 1352);
static_assert(offsetof(RobotState, ddq_d) == 1408);
static_assert(offsetof(RobotState, tau_ext_hat_filtered) == 1672);
static_assert(offsetof(RobotState, O_F_ext_hat_K) == 1728);
static_assert(offsetof(RobotState, theta) == 2168 && offsetof(RobotState, dtheta) == 2224);
static_assert(offsetof(RobotState, motion_generator) == 2280);
static_assert(offsetof(RobotState, errors) == 2282 && offsetof(RobotState, reflex_reason) == 2323);
static_assert(offsetof(RobotState, robot_mode) == 2364);
// Only success_rate is not aligned there: it follows at once.
static_assert(offsetof(RobotState, robot_mode) + 1 + sizeof(double) == kRobotStateSize);

/// The answer to a state.
struct RobotCommand {
  std::uint64_t message_id;  ///< of the state that is answered
  Joints q_c, dq_c;
  Matrix4 O_T_EE_c;
  Wrench O_dP_EE_c;
  std::array<double, 2> elbow_c;
  std::uint8_t valid_elbow;
  std::uint8_t motion_generation_finished;
  Joints tau_J_d;  ///< without gravity
};
inline constexpr std::size_t kRobotCommandSize = 370;
static_assert(offsetof(RobotCommand, q_c) == 8 && offsetof(RobotCommand, dq_c) == 64);
static_assert(offsetof(RobotCommand, O_T_EE_c) == 120 && offsetof(RobotCommand, O_dP_EE_c) == 248);
static_assert(offsetof(RobotCommand, elbow_c) == 296 && offsetof(RobotCommand, valid_elbow) == 312);
static_assert(offsetof(RobotCommand, motion_generation_finished) == 313);
// tau_J_d follows at once.
static_assert(offsetof(RobotCommand, motion_generation_finished) + 1 + sizeof(Joints) ==
              kRobotCommandSize);

Bytes Encode(const RobotState& state);
Bytes Encode(const RobotCommand& command);
/// @throws std::invalid_argument for another number of bytes.
RobotState DecodeRobotState(const Bytes& bytes);
RobotCommand DecodeRobotCommand(const Bytes& bytes);

/// The command channel: every message begins with this.
enum class Request : std::uint32_t {
  kConnect,
  kMove,
  kStopMove,
  kGetCartesianLimit,
  kSetCollisionBehavior,
  kSetJointImpedance,
  kSetCartesianImpedance,
  kSetGuidingMode,
  kSetEEToK,
  kSetNEToEE,
  kSetLoad,
  kSetFilters,
  kAutomaticErrorRecovery,
  kLoadModelLibrary
};
inline constexpr std::uint32_t kNumRequests = 14;

struct Header {
  Request request;
  std::uint32_t id;    ///< the client's; a reply repeats it
  std::uint32_t size;  ///< with this header [bytes]
};
static_assert(sizeof(Header) == 12);

struct Message {
  Request request = Request::kConnect;
  std::uint32_t id = 0;
  Bytes payload;  ///< of a reply: the status first
};

// Payloads of requests. Those not here: StopMove and AutomaticErrorRecovery have none.
struct ConnectRequest {
  std::uint16_t version, udp_port;
};
struct MoveRequest {
  std::uint32_t controller;        ///< as Controller, up to kExternalTorque
  std::uint32_t motion_generator;  ///< as MotionGenerator without kIdle: 0 is kJointPosition
  std::array<double, 3> path_deviation, goal_deviation;
};
struct CartesianLimitRequest {
  std::int32_t id;
};
/// Above `lower`, a contact is told; above `upper`, the motion is aborted by a reflex. Both while
/// the robot accelerates and at other times ("nominal").
struct CollisionBehaviorRequest {
  Joints lower_torque_acceleration, upper_torque_acceleration;
  Joints lower_torque_nominal, upper_torque_nominal;
  Wrench lower_force_acceleration, upper_force_acceleration;
  Wrench lower_force_nominal, upper_force_nominal;
};
struct JointImpedanceRequest {
  Joints stiffness;  ///< N m/rad, 0 to 14250 each
};
struct CartesianImpedanceRequest {
  Wrench stiffness;
};
struct GuidingModeRequest {
  std::array<std::uint8_t, 6> axes;
  std::uint8_t nullspace;
};
struct FrameRequest {
  Matrix4 pose;  ///< EE_T_K or NE_T_EE
};
struct LoadRequest {
  double mass_kg;
  std::array<double, 3> F_x_Cload;
  std::array<double, 9> I_load;
};
struct FiltersRequest {
  std::array<double, 5> cutoff_hz;
};
struct ModelLibraryRequest {
  std::uint8_t architecture, system;
};
static_assert(sizeof(ConnectRequest) == 4 && sizeof(MoveRequest) == 56);
static_assert(sizeof(CollisionBehaviorRequest) == 416 && sizeof(JointImpedanceRequest) == 56);
static_assert(sizeof(CartesianImpedanceRequest) == 48 && sizeof(GuidingModeRequest) == 7);
static_assert(sizeof(FrameRequest) == 128 && sizeof(LoadRequest) == 104);
static_assert(sizeof(FiltersRequest) == 40 && sizeof(ModelLibraryRequest) == 2);

/// How many bytes the payload of a request has.
std::size_t PayloadSize(Request request);
/// `Move`, `Stop Move`, ...
const char* Name(Request request);

// The first byte of a reply. 0 is success, for every request.
namespace status {
inline constexpr std::uint8_t kSuccess = 0;
inline constexpr std::uint8_t kIncompatibleLibraryVersion = 1;  ///< of Connect
inline constexpr std::uint8_t kNotPossible = 1;      ///< of all but Connect, Move, LoadModelLibrary
inline constexpr std::uint8_t kInvalidArgument = 2;  ///< of getters and setters
inline constexpr std::uint8_t kManualRecoveryRequired = 2;  ///< of AutomaticErrorRecovery
inline constexpr std::uint8_t kNoModelLibrary = 1;          ///< of LoadModelLibrary
}  // namespace status

enum class MoveStatus : std::uint8_t {
  kSuccess,
  kMotionStarted,  ///< a second reply follows at the motion's end
  kPreempted,
  kNotPossible,
  kStartAtSingularPose,
  kInvalidArgument,
  kReflexAborted,
  kEmergencyAborted,  ///< by the user stop
  kInputErrorAborted,
  kAborted
};

/// The bytes of a request's payload, and back. @throws std::invalid_argument for a wrong size.
template <typename Payload>
Bytes ToBytes(const Payload& payload) {
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(&payload);
  return Bytes(begin, begin + sizeof(Payload));
}
void CopyExactly(const Bytes& bytes, void* to, std::size_t size);
template <typename Payload>
Payload FromBytes(const Bytes& bytes) {
  Payload payload;
  CopyExactly(bytes, &payload, sizeof(Payload));
  return payload;
}

/// The payload of a reply to Connect: the status and the server's version.
Bytes ConnectReply(std::uint8_t status, std::uint16_t version);
/// The payload of a reply to GetCartesianLimit: there are no virtual walls.
Bytes NoCartesianLimit(std::uint8_t status);

}  // namespace sidestep::robot::fci
