#pragma once

#include <map>
#include <string>
#include <vector>

#include "sidestep/record/recording.h"

namespace sidestep::bench {

// Would this have tripped? What the robot was sent, over its own limits: the largest share of all
// joints and moments. A robot stops by itself where one reaches 1. NaN where a limit is not known.
//
// Velocity, acceleration and jerk are what a Panda's controller judges: backward differences of the
// sent positions from tick to tick, from rest, not what the follower says of itself.
double VelocityUse(const record::Recording& recording);
double AccelerationUse(const record::Recording& recording);
double JerkUse(const record::Recording& recording);
/// Of the tool, as the sent positions move it: its speed's and direction's change from tick to
/// tick.
double ToolAccelerationUse(const record::Recording& recording);
/// The same over what the robot is known to stop at, though no limit of its forbids it.
double ToolReflexUse(const record::Recording& recording);

/// The metrics that say whether a robot would have stopped by itself, with words for a person:
/// those above, and how fast the motors' torques changed (limit_metrics.h).
struct TripMetric {
  const char* name;
  const char* words;
};
inline constexpr TripMetric kTripMetrics[] = {
    {"velocity_use", "velocity"},
    {"acceleration_use", "acceleration"},
    {"jerk_use", "jerk"},
    {"commanded_torque_rate_use", "torque rate"},
    {"tool_acceleration_use", "tool acceleration"},
    {"tool_reflex_use", "tool reflex"},
};

/// Those of them that reach 1.
std::vector<TripMetric> TrippedBy(const std::map<std::string, double>& metrics);
/// In words: "velocity, tool reflex"; if there are none, "no", or "not by what is known" where some
/// of the robot's limits are not.
std::string TellTrips(const std::map<std::string, double>& metrics);

}  // namespace sidestep::bench
