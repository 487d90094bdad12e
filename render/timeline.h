#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/time.h"
#include "sidestep/record/recording.h"

namespace sidestep::render {

// What a recording says about one moment. Before its first sample the first one counts, after its
// last one the last.

/// The measured joint positions, linear between samples; shape n. Needs at least one control
/// sample.
Eigen::VectorXd JointsAt(const record::Recording& recording, EpisodeTime t);

/// The pose between two poses: the position linear, the rotation along the shorter arc at an even
/// rate. `times` increase and are as many as `poses`, at least one.
Pose PoseAt(const std::vector<EpisodeTime>& times, const std::vector<Pose>& poses, EpisodeTime t);

/// X_WO of each obstacle: as it truly was; where nobody knows that, as on hardware, as its camera
/// saw it the last time (before, the first time), or, of virtual ones, as the recorded scenario
/// prescribes it.
std::vector<Pose> ObstaclesAt(const record::Recording& recording, EpisodeTime t);

/// How fast the fastest obstacle moves [m/s]; where a camera saw them, by where it saw each in the
/// quarter of a second before. NaN if it saw none twice in that time: nobody knows.
double ObstacleSpeedAt(const record::Recording& recording, EpisodeTime t);

/// The cycle whose plan the robot follows, or null before the first plan takes effect.
const CycleRecord* CycleInForce(const record::Recording& recording, EpisodeTime t);

}  // namespace sidestep::render
