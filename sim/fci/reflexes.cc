#include "sidestep/sim/fci/reflexes.h"

#include <cmath>

#include "sidestep/sim/fci/motion_check.h"

namespace sidestep::sim::fci {
namespace {

template <typename Values>
Values Above(const Values& values, const Values& thresholds) {
  Values flags{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    flags[i] = std::abs(values[i]) > thresholds[i] ? 1 : 0;
  }
  return flags;
}

template <typename Values>
bool Any(const Values& flags) {
  for (const double flag : flags) {
    if (flag != 0) return true;
  }
  return false;
}

template <typename Values>
void MoveTowards(const Values& target, Values& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += kTick_s / (kTick_s + kEstimateTime_s) * (target[i] - values[i]);
  }
}

}  // namespace

robot::fci::CollisionBehaviorRequest DefaultCollisionBehavior() {
  constexpr robot::fci::Joints kTorque = {20, 20, 18, 18, 16, 14, 12};
  constexpr robot::fci::Wrench kForce = {20, 20, 20, 25, 25, 25};
  return {kTorque, kTorque, kTorque, kTorque, kForce, kForce, kForce, kForce};
}

Contacts FindContacts(const ExternalForce& force,
                      const robot::fci::CollisionBehaviorRequest& thresholds,
                      bool is_accelerating) {
  using robot::fci::Error;
  const auto& t = thresholds;
  Contacts found;
  found.joint_contact =
      Above(force.tau, is_accelerating ? t.lower_torque_acceleration : t.lower_torque_nominal);
  found.joint_collision =
      Above(force.tau, is_accelerating ? t.upper_torque_acceleration : t.upper_torque_nominal);
  found.cartesian_contact =
      Above(force.O_F_K, is_accelerating ? t.lower_force_acceleration : t.lower_force_nominal);
  found.cartesian_collision =
      Above(force.O_F_K, is_accelerating ? t.upper_force_acceleration : t.upper_force_nominal);
  if (Any(found.joint_collision)) found.reflexes |= robot::fci::Only(Error::kJointReflex);
  if (Any(found.cartesian_collision)) found.reflexes |= robot::fci::Only(Error::kCartesianReflex);
  return found;
}

ExternalForce FilterForce(const ExternalForce& before, const ExternalForce& now) {
  ExternalForce filtered = before;
  MoveTowards(now.tau, filtered.tau);
  MoveTowards(now.O_F_K, filtered.O_F_K);
  return filtered;
}

}  // namespace sidestep::sim::fci
