#pragma once

#include "core/pose.h"
#include "core/time.h"
#include "sdf/tracking/tracked_object.h"

namespace sidestep {

/// Says where a moving thing will be. One object in, one pose out: no maps, no robot.
///
/// A pure function of its arguments, safe from many threads. At the time of the latest sighting it
/// is the pose seen then; it is finite and continuous in t at every finite t, earlier ones too.
class ObstaclePredictor {
 public:
  virtual ~ObstaclePredictor() = default;

  /// X_WO at time `t` of the episode (not so much ahead).
  virtual Pose PredictPose(const TrackedObject& object, EpisodeTime t) const = 0;
};

}  // namespace sidestep
