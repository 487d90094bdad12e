#pragma once

#include <Eigen/Core>
#include <functional>

#include "sidestep/core/pose.h"
#include "sidestep/core/time.h"
#include "sidestep/sdf/tracking/tracked_object.h"

namespace sidestep::sdf {

/// Where one object will be, as believed at its latest sighting. Both are pure functions of the
/// time of the episode (not of so much ahead), safe from many threads, finite and continuous at
/// every finite time, earlier ones too.
struct PredictedMotion {
  std::function<Pose(EpisodeTime)> X_WO;
  /// Of the error of X_WO's position [m^2], in W: symmetric, positive semidefinite, and that of the
  /// sighting itself at the sighting's time.
  std::function<Eigen::Matrix3d(EpisodeTime)> covariance_m2;
};

/// Says where a moving thing will be. One object in, its motion out: no maps, no robot.
///
/// At the time of the latest sighting the motion passes through the pose seen then, also where a
/// filter would rather stand elsewhere: the object's shape was seen there, and a filter that lags
/// in a turn must not draw it behind itself. Filters smooth the velocity.
class ObstaclePredictor {
 public:
  virtual ~ObstaclePredictor() = default;

  /// A pure function of `object`, which need not outlive the answer.
  virtual PredictedMotion Predict(const TrackedObject& object) const = 0;

  /// X_WO at time `t` of the episode.
  Pose PredictPose(const TrackedObject& object, EpisodeTime t) const {
    return Predict(object).X_WO(t);
  }
};

}  // namespace sidestep::sdf
