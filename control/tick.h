#pragma once

#include "sidestep/control/joint_vector.h"
#include "sidestep/core/time.h"

namespace sidestep::control {

/// What a robot's controller tells of itself at one tick.
struct Measured {
  EpisodeTime t;
  JointVector q, v;      ///< as measured, shape n
  JointPoint commanded;  ///< the motion that it was last told, as it understood it

  JointVector torque{};     ///< [N m] of the motors, shape n; empty: not known
  JointVector tau_ext{};    ///< [N m] what pushes from outside, shape n; empty: not known
  double success_rate = 1;  ///< of the latest packets, 0 to 1
  int lost_in_a_row = 0;    ///< packets, until now
  bool is_fit = true;       ///< whether it says that it can move
};

/// What the motors are told in one tick.
struct Command {
  JointPoint motion;
};

/// One tick, as it is logged: what was measured at its beginning and what was commanded then.
struct TickRecord {
  EpisodeTime t;
  JointVector q, v, torque;
  JointPoint command;
};

}  // namespace sidestep::control
