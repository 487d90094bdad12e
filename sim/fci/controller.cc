#include "sidestep/sim/fci/controller.h"

#include <cmath>

namespace sidestep::sim::fci {

using robot::fci::Joints;

Joints ImpedanceTorque(const JointImpedance& gains, const Reference& reference, const Joints& q,
                       const Joints& dq) {
  Joints torque;
  for (std::size_t i = 0; i < torque.size(); ++i) {
    torque[i] =
        gains.stiffness[i] * (reference.q[i] - q[i]) + gains.damping[i] * (reference.dq[i] - dq[i]);
  }
  return torque;
}

robot::fci::ErrorSet CheckTorque(const Joints& before, const Joints& after,
                                 const JointTable& limits) {
  robot::fci::ErrorSet errors;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const double rate = (after[i] - before[i]) / kTick_s;
    if (!(std::abs(rate) < limits[i].torque_rate_max)) {
      errors |= robot::fci::Only(robot::fci::Error::kTorqueDiscontinuity);
    }
  }
  return errors;
}

}  // namespace sidestep::sim::fci
