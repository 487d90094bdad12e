#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/samples.h"

namespace sidestep::robot {

/// A robot failed, or stopped by itself. Carries what it was told and did last, as far as it is
/// known: the ticks before the failure, in order.
class RobotError : public std::runtime_error {
 public:
  explicit RobotError(const std::string& what, std::vector<ControlSample> last_ticks = {})
      : std::runtime_error(what), last_ticks_(std::move(last_ticks)) {}

  const std::vector<ControlSample>& last_ticks() const { return last_ticks_; }

 private:
  std::vector<ControlSample> last_ticks_;
};

}  // namespace sidestep::robot
