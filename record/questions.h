#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "sidestep/core/time.h"
#include "sidestep/record/recording.h"

namespace sidestep::record {

// What metrics, captions and reports ask of a recording, answered once, so that none of them can
// say something else than another.

/// When the last sample was taken; zero if there is none.
EpisodeTime EndOf(const Recording& recording);
/// Why the episode was aborted, at its end; none if it was not.
std::optional<std::string> WhyAborted(const Recording& recording);
/// The latest tick at or before `t`, or the first one; null: there is none.
const ControlSample* TickAt(const Recording& recording, EpisodeTime t);

/// The robot touched something that it may not touch.
struct Touch {
  EpisodeTime t;                                  ///< of the physics step at which it did
  std::string object;                             ///< which
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m] where
};
/// The first one of the episode, up to `t` where that is given.
std::optional<Touch> FirstTouch(const Recording& recording);
std::optional<Touch> FirstTouch(const Recording& recording, EpisodeTime t);
/// The latest one of the last `window` before `t`, if there was one.
std::optional<Touch> TouchWithin(const Recording& recording, EpisodeTime t, HorizonOffset window);

/// The robot's true distance from all that it may not touch, as judged at one moment.
struct Clearance {
  EpisodeTime t;
  double clearance_m = 0;  ///< negative: penetration
};
/// As last judged at `t`, at first the first one; none without truth.
std::optional<Clearance> ClearanceAt(const Recording& recording, EpisodeTime t);
/// The least one of the episode, up to `t` where that is given; of equal ones the first.
std::optional<Clearance> LeastClearance(const Recording& recording);
std::optional<Clearance> LeastClearance(const Recording& recording, EpisodeTime t);

/// What the robot's supervisor began to find in the last `window` before `t`: the gravest, of equal
/// ones the latest.
std::optional<SafetyEvent> FindingWithin(const Recording& recording, EpisodeTime t,
                                         HorizonOffset window);
/// When it first made the robot hold or brake; none if it never did.
std::optional<EpisodeTime> FirstStop(const Recording& recording);

}  // namespace sidestep::record
