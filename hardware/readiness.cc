#include "sidestep/hardware/readiness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sidestep/core/number_text.h"

namespace sidestep::hardware {
namespace {

using control::SafetyCheck;
using robot::fci::Joints;
using robot::fci::RobotMode;

// The Panda's; a robot cannot be asked for its own. Source: frankaemika/docs,
// control-parameters-joint-panda.csv, and libfranka 0.9.2, rate_limiting.h (Apache-2.0).
struct Limits {
  double q_min, q_max, v, a, jerk, torque;
};
constexpr std::array<Limits, 7> kPanda = {{
    {-2.8973, 2.8973, 2.175, 15, 7500, 87},
    {-1.7628, 1.7628, 2.175, 7.5, 3750, 87},
    {-2.8973, 2.8973, 2.175, 10, 5000, 87},
    {-3.0718, -0.0698, 2.175, 12.5, 6250, 87},
    {-2.8973, 2.8973, 2.61, 15, 7500, 12},
    {-0.0175, 3.7525, 2.61, 20, 10000, 12},
    {-2.8973, 2.8973, 2.61, 20, 10000, 12},
}};

// From the flange to the end effector of the Franka Hand, which robot.yaml describes: turned by
// -45 degrees, its tip 0.1034 m out. Source: franka_ros, panda.urdf.xacro (Apache-2.0).
constexpr double kHand_m = 0.1034, kHandTurn_rad = -0.7853981633974483;

constexpr double kSpeed_rad_s = 1e-3;  // below, it rests
constexpr double kAside_rad = 0.005;   // where it is and where it means to be
constexpr double kFrame = 1e-3;        // of the hand's frame, m and parts of a rotation
constexpr double kLoad_kg = 0.01;

std::string Joint(std::size_t j) { return "joint " + std::to_string(j + 1); }

std::string Radians(double value) { return FiniteText("{:.4g} rad", value, "no number"); }

std::optional<Objection> CheckMode(const RobotSnapshot& state, const robot::RobotModel&) {
  if (state.mode == RobotMode::kIdle) return std::nullopt;
  return Objection{SafetyCheck::kRobotMode,
                   "the robot is not idle but in the mode '" +
                       std::string(robot::fci::Name(state.mode)) +
                       "'; see to the cause, then `sidestep hardware recover`"};
}

// Narrower limits than the robot's own are everybody's right.
std::optional<Objection> CheckLimits(const RobotSnapshot&, const robot::RobotModel& robot) {
  for (std::size_t j = 0; j < kPanda.size(); ++j) {
    const robot::JointLimits& ours = robot.limits()[j];
    const Limits& its = kPanda[j];
    const struct {
      const char* key;
      double value, limit;
    } bounds[] = {{"q_max_rad", ours.q_max, its.q_max},
                  {"q_min_rad", -ours.q_min, -its.q_min},
                  {"v_max_rad_s", ours.v_max, its.v},
                  {"a_max_rad_s2", ours.a_max, its.a},
                  {"jerk_max_rad_s3", ours.jerk_max, its.jerk},
                  {"torque_max_n_m", ours.torque_max, its.torque}};
    for (const auto& bound : bounds) {
      if (bound.value <= bound.limit) continue;
      return Objection{
          SafetyCheck::kConfiguration,
          "robot.yaml: " + std::string(bound.key) + " of " + Joint(j) + " is wider than a Panda's",
          std::abs(bound.value), std::abs(bound.limit)};
    }
  }
  return std::nullopt;
}

std::optional<Objection> CheckEndEffector(const RobotSnapshot& state, const robot::RobotModel&) {
  const double c = std::cos(kHandTurn_rad), s = std::sin(kHandTurn_rad);
  const robot::fci::Matrix4 hand = {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, kHand_m, 1};
  double off = 0;
  for (std::size_t i = 0; i < hand.size(); ++i) {
    off = std::max(off, std::abs(state.F_T_EE[i] - hand[i]));
  }
  if (!(off <= kFrame)) {
    return Objection{SafetyCheck::kConfiguration,
                     "the robot's end effector is not the Franka Hand of robot.yaml", off, kFrame};
  }
  if (!(state.load_kg <= kLoad_kg)) {
    return Objection{SafetyCheck::kConfiguration,
                     "the robot carries a load of " + FiniteText("{:.3g} kg", state.load_kg) +
                         ", robot.yaml has none",
                     state.load_kg, kLoad_kg};
  }
  return std::nullopt;
}

std::optional<Objection> CheckRange(const RobotSnapshot& state, const robot::RobotModel& robot) {
  for (std::size_t j = 0; j < state.q.size(); ++j) {
    const robot::JointLimits& limits = robot.limits()[j];
    if (state.q[j] > limits.q_min && state.q[j] < limits.q_max) continue;
    return Objection{SafetyCheck::kConfiguration,
                     Joint(j) + " is at " + Radians(state.q[j]) + ", outside its limits",
                     state.q[j], state.q[j] < 0 ? limits.q_min : limits.q_max};
  }
  return std::nullopt;
}

std::optional<Objection> CheckRest(const RobotSnapshot& state, const robot::RobotModel&) {
  for (std::size_t j = 0; j < state.q.size(); ++j) {
    if (!(std::abs(state.dq[j]) < kSpeed_rad_s)) {
      return Objection{SafetyCheck::kRecovery, Joint(j) + " does not rest", std::abs(state.dq[j]),
                       kSpeed_rad_s};
    }
    const double aside_rad = std::abs(state.q[j] - state.q_d[j]);
    if (!(aside_rad <= kAside_rad)) {
      return Objection{SafetyCheck::kRecovery,
                       Joint(j) + " is " + Radians(aside_rad) +
                           " from where the robot means it to be: a motion would begin elsewhere",
                       aside_rad, kAside_rad};
    }
  }
  return std::nullopt;
}

constexpr std::optional<Objection> (*kChecks[])(const RobotSnapshot&, const robot::RobotModel&) = {
    CheckMode, CheckLimits, CheckEndEffector, CheckRange, CheckRest};

}  // namespace

std::optional<Objection> WhyNotReady(const RobotSnapshot& state, const robot::RobotModel& robot) {
  for (const auto check : kChecks) {
    if (auto objection = check(state, robot)) return objection;
  }
  return std::nullopt;
}

RobotSnapshot AwaitReady(FciDriver& driver, const robot::RobotModel& robot) {
  constexpr int kLongest_ms = 500;  // a robot tells of itself each millisecond
  for (int ms = 0;; ++ms) {
    const RobotSnapshot state = driver.ReadOnce();
    const std::optional<Objection> objection = WhyNotReady(state, robot);
    if (!objection) return state;
    if (objection->check != SafetyCheck::kRecovery || ms == kLongest_ms) throw NotReady(*objection);
  }
}

}  // namespace sidestep::hardware
