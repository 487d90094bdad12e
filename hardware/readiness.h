#pragma once

#include <limits>
#include <optional>
#include <string>

#include "sidestep/control/safety.h"
#include "sidestep/hardware/fci_driver.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::hardware {

/// Why a robot is not to be moved, as it is.
struct Objection {
  control::SafetyCheck check = control::SafetyCheck::kConfiguration;
  std::string why;
  /// What was found, and what it may be, where that is a number; units as the check's.
  double value = std::numeric_limits<double>::quiet_NaN(), limit = value;
};

/// An objection as an error.
class NotReady : public FciError {
 public:
  explicit NotReady(const Objection& objection)
      : FciError(Kind::kRefused, objection.why), objection_(objection) {}

  const Objection& objection() const { return objection_; }

 private:
  Objection objection_;
};

/// Asked before anything is sent to a robot: whether it is idle and at rest, and the one that
/// `robot` describes, as far as it tells. What else must be in order before it moves, as the
/// calibration of a camera, is one more function of the list in readiness.cc.
std::optional<Objection> WhyNotReady(const RobotSnapshot& state, const robot::RobotModel& robot);

/// The same of a robot as it is now. One that only does not rest is given half a second: it may
/// have stopped a moment ago, and what is measured at rest trembles.
/// @return its state. @throws NotReady; FciError.
RobotSnapshot AwaitReady(FciDriver& driver, const robot::RobotModel& robot);

}  // namespace sidestep::hardware
