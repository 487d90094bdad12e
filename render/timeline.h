#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/recording.h"
#include "core/time.h"

namespace sidestep {

// What a recording says about one moment. Before its first sample the first one counts, after its
// last one the last.

/// When the last sample was taken; zero if there is none.
EpisodeTime EndOf(const Recording& recording);

/// The measured joint positions, linear between samples; shape n. Needs at least one control
/// sample.
Eigen::VectorXd JointsAt(const Recording& recording, EpisodeTime t);

/// The pose between two poses: the position linear, the rotation along the shorter arc at an even
/// rate. `times` increase and are as many as `poses`, at least one.
Pose PoseAt(const std::vector<EpisodeTime>& times, const std::vector<Pose>& poses, EpisodeTime t);

/// X_WO of each obstacle; empty if the recording has no truth samples.
std::vector<Pose> ObstaclesAt(const Recording& recording, EpisodeTime t);

/// How fast the fastest obstacle moves [m/s].
double ObstacleSpeedAt(const Recording& recording, EpisodeTime t);

/// The cycle whose plan the robot follows, or null before the first plan takes effect.
const CycleRecord* CycleInForce(const Recording& recording, EpisodeTime t);

/// The robot's clearance from all it may not touch, as last judged.
struct Clearance {
  EpisodeTime t;
  double clearance_m = 0;
};
std::optional<Clearance> ClearanceAt(const Recording& recording, EpisodeTime t);
/// The least one up to `t`; of equal ones the first.
std::optional<Clearance> LeastClearance(const Recording& recording, EpisodeTime t);

struct Touch {
  EpisodeTime t;
  std::string object;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m] where
};
std::optional<Touch> FirstTouch(const Recording& recording);
/// The latest touch of the last `window` before `t`, if there was one.
std::optional<Touch> TouchWithin(const Recording& recording, EpisodeTime t, HorizonOffset window);

}  // namespace sidestep
