#pragma once

#include "sidestep/robot/joint.h"

namespace sidestep::robot {

/// What robot.yaml calls the limits of a joint, with the units of its kind.
struct LimitKeys {
  const char *q_min, *q_max, *v_max, *a_max, *jerk_max, *torque_max, *torque_rate_max;
};

constexpr LimitKeys LimitKeysOf(JointKind kind) {
  if (kind == JointKind::kPrismatic) {
    return {"q_min_m",       "q_max_m",     "v_max_m_s",         "a_max_m_s2",
            "jerk_max_m_s3", "force_max_n", "force_rate_max_n_s"};
  }
  return {"q_min_rad",       "q_max_rad",      "v_max_rad_s",          "a_max_rad_s2",
          "jerk_max_rad_s3", "torque_max_n_m", "torque_rate_max_n_m_s"};
}

}  // namespace sidestep::robot
