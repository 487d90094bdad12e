#pragma once

#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/robot/fci/wire.h"
#include "sidestep/sim/fci/fault_script.h"

namespace sidestep::sim::fci {

/// Plays the faults of a script, tick by tick. What the network loses and what acts on the joints
/// happens here; what concerns the robot's mode or its link is told to who asks.
class FaultPlayer {
 public:
  explicit FaultPlayer(const FaultScript& script);

  /// Begins what is due by now. @return that part of it which is not done here: kUserStop,
  /// kGuiding, kError, kCutLink.
  std::vector<Fault> Begin(double t_s, const robot::fci::Joints& q);

  /// Time begins at 0 again: what lasts has been.
  void BeginAnew() { lasting_.clear(); }

  /// A motion begins: what earlier ones would have lost is forgotten.
  void BeginMotion() { lost_commands_ = lost_states_ = 0; }
  /// Whether the state of this tick is lost on its way.
  bool loses_states() const { return lost_states_ > 0; }
  /// The same; and counts it as lost.
  bool TakeLostState() { return lost_states_ > 0 && lost_states_-- > 0; }
  /// Whether the command of this tick is lost on its way; to be asked once for each.
  bool TakeLostCommand(double t_s);

  /// What the controller aims beside its reference [rad].
  robot::fci::Joints Offset(double t_s) const;
  /// What acts on the joints besides the motors [N m].
  robot::fci::Joints Disturbance(double t_s, const robot::fci::Joints& q,
                                 const robot::fci::Joints& dq,
                                 const robot::fci::Joints& motor_torque) const;

 private:
  std::vector<Fault> waiting_;  ///< by time, the next one last
  std::vector<Fault> lasting_;  ///< begun
  RandomStream random_;
  robot::fci::Joints blocked_at_{};
  int lost_commands_ = 0, lost_states_ = 0;
};

}  // namespace sidestep::sim::fci
