#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/core/tag_track.h"
#include "sidestep/hardware/body_pose.h"
#include "sidestep/hardware/tag_detector.h"
#include "sidestep/robot/frame_source.h"
#include "sidestep/robot/sensor.h"

namespace sidestep::hardware {

/// A body that stands still at a known place, by whose tags one sees whether the camera was moved.
struct ReferenceBody {
  TaggedBody body;
  Pose X_WO;
};

/// A picture, and what came of it.
struct Look {
  const robot::Frame& frame;
  const std::vector<TagDetection>& tags;
  const Scan& scan;
};

struct TagSensorOptions {
  Pose X_WC;                       ///< of the camera, as it was calibrated
  std::vector<TaggedBody> bodies;  ///< what moves
  std::vector<ReferenceBody> references;
  Eigen::Matrix3Xd p_WStatic;  ///< [m] 3 x N, the cells that what stands still fills
  TagDetectorOptions detector;
  TagTrackOptions track;
  double edge_sigma_px = kEdgeSigma_px;
  double most_reprojection_px = 1;  ///< root mean square; beyond, it is no such body
  double nearest_m = 0.2, farthest_m = 3;
  double turn_rate_rad_s = 1;  ///< how fast bodies may turn: what a past look is worth
  double most_drift_m = 0.01;  ///< of a reference body; beyond, the camera was moved
  std::function<void(const Look&)> on_look;  ///< is shown every picture
};

/// Bodies that a camera knows by their tags, as observations with covariance: found in each
/// picture, located by all of their tags that are seen, gated and followed (core/tag_track.h).
///
/// An observation is what was seen, at the time of capture, once it belongs to a track; it is not
/// the filter's estimate, because who predicts it filters it. What is not found, or does not fit,
/// is not there.
class TagSensor final : public robot::Sensor {
 public:
  /// @throws InputError if this build cannot find tags.
  TagSensor(std::unique_ptr<robot::FrameSource> frames, TagSensorOptions options);

  EpisodeTime NextDue() const override { return frames_->NextDue(); }
  /// @throws RobotError if the camera was moved, or is gone.
  std::optional<Scan> Read(EpisodeTime now) override;

  /// The track of a body, by its place among the options'.
  const TagTrack& track(std::size_t body) const { return followed_[body].track; }

 private:
  struct Followed {
    TagTrack track;
    // How it is turned, as it was seen the last time.
    EpisodeTime t;
    Eigen::Quaterniond R_WO = Eigen::Quaterniond::Identity();
    double sigma_rad = 0;
    bool was_seen = false;
  };

  std::optional<ObjectObservation> Observe(const robot::Frame& frame,
                                           const std::vector<TagDetection>& tags,
                                           const TaggedBody& body, Followed* followed) const;
  void CheckReferences(const robot::Frame& frame, const std::vector<TagDetection>& tags);

  std::unique_ptr<robot::FrameSource> frames_;
  TagSensorOptions options_;
  TagDetector detector_;
  std::vector<Followed> followed_;  // of each body
  int num_drifted_ = 0;             // pictures in a row in which a reference was elsewhere
};

}  // namespace sidestep::hardware
