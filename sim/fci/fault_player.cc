#include "sidestep/sim/fci/fault_player.h"

#include <algorithm>
#include <utility>

namespace sidestep::sim::fci {
namespace {

using robot::fci::Joints;

// Own choices.
constexpr double kBlockStiffness = 1e4, kBlockDamping = 60;  // N m/rad, N m s/rad
constexpr double kFrictionSpeed_rad_s = 0.01;                // below, friction fades to zero

std::size_t Joint(const Fault& fault) { return static_cast<std::size_t>(fault.joint); }

}  // namespace

FaultPlayer::FaultPlayer(const FaultScript& script)
    : waiting_(script.faults), random_(script.seed, "fci packet loss") {
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [](const Fault& a, const Fault& b) { return a.at_s < b.at_s; });
  std::reverse(waiting_.begin(), waiting_.end());
}

std::vector<Fault> FaultPlayer::Begin(double t_s, const Joints& q) {
  constexpr double kRounding_s = 1e-9;
  std::vector<Fault> others;
  while (!waiting_.empty() && waiting_.back().at_s <= t_s + kRounding_s) {
    Fault fault = waiting_.back();
    waiting_.pop_back();
    fault.at_s = t_s;
    switch (fault.kind) {
      case FaultKind::kLoseCommands:
        lost_commands_ = fault.count;
        break;
      case FaultKind::kLoseStates:
        lost_states_ = fault.count;
        break;
      case FaultKind::kUserStop:
      case FaultKind::kGuiding:
      case FaultKind::kError:
      case FaultKind::kCutLink:
        others.push_back(fault);
        break;
      case FaultKind::kBlockedJoint:
        blocked_at_[Joint(fault)] = q[Joint(fault)];
        lasting_.push_back(fault);
        break;
      case FaultKind::kLoseSome:
      case FaultKind::kExternalTorque:
      case FaultKind::kFriction:
      case FaultKind::kTrackingOffset:
        lasting_.push_back(fault);
        break;
    }
  }
  return others;
}

bool FaultPlayer::TakeLostCommand(double t_s) {
  bool is_lost = lost_commands_ > 0;
  if (is_lost) --lost_commands_;
  for (const Fault& fault : lasting_) {
    if (fault.kind != FaultKind::kLoseSome || !fault.IsActive(t_s)) continue;
    is_lost = random_.Uniform() < fault.rate || is_lost;
  }
  return is_lost;
}

Joints FaultPlayer::Offset(double t_s) const {
  Joints offset{};
  for (const Fault& fault : lasting_) {
    if (fault.kind == FaultKind::kTrackingOffset && fault.IsActive(t_s)) {
      offset[Joint(fault)] += fault.offset_rad;
    }
  }
  return offset;
}

Joints FaultPlayer::Disturbance(double t_s, const Joints& q, const Joints& dq,
                                const Joints& motor_torque) const {
  Joints torque{};
  for (const Fault& fault : lasting_) {
    if (!fault.IsActive(t_s)) continue;
    const std::size_t i = Joint(fault);
    if (fault.kind == FaultKind::kExternalTorque) torque[i] += fault.rate * (t_s - fault.at_s);
    if (fault.kind == FaultKind::kFriction) {
      torque[i] -= fault.torque_n_m * std::clamp(dq[i] / kFrictionSpeed_rad_s, -1.0, 1.0);
    }
    if (fault.kind == FaultKind::kBlockedJoint) {
      torque[i] =
          kBlockStiffness * (blocked_at_[i] - q[i]) - kBlockDamping * dq[i] - motor_torque[i];
    }
  }
  return torque;
}

}  // namespace sidestep::sim::fci
