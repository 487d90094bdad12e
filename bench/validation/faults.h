#pragma once

#include <span>
#include <string>

#include "sidestep/bench/validation/faulty_sensor.h"

namespace sidestep::bench {

/// Something that fails in the middle of a motion, and what has to come of it.
struct ValidationFault {
  const char* name;
  /// The lines under `faults:` of a faults file (docs/hardware.md); empty: it is not the robot's.
  const char* on_the_wire = "";
  SensorFaults sensor = {};
  /// One of these words is in what the supervisor found ("tracking brake") or in the reason why the
  /// episode was aborted; `|` between them.
  const char* expected = "";
  bool may_go_on = false;  ///< once the cause has gone; else it rests for good
};

/// All there are; the first is none. To add one: a row of the table in faults.cc.
std::span<const ValidationFault> ValidationFaults();
/// @throws std::invalid_argument for an unknown name.
const ValidationFault& ValidationFaultOf(const std::string& name);

}  // namespace sidestep::bench
