#pragma once

#include <span>
#include <string>

namespace sidestep::bench {

/// How fast the planner is, and how good the robot's network.
struct Timing {
  const char* name;
  double cycle_factor = 1;  ///< a planning cycle takes so many times what it is charged
  double lost_share = 0;    ///< of the packets to the robot; > 0 needs one
};

/// All there are; the first is the nominal one.
std::span<const Timing> Timings();
/// @throws std::invalid_argument for an unknown name.
const Timing& TimingOf(const std::string& name);

}  // namespace sidestep::bench
