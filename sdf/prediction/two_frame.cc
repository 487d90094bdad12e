#include "sidestep/sdf/prediction/two_frame.h"

#include "sidestep/sdf/prediction/motion_filter.h"

namespace sidestep::sdf {
namespace {

class TwoFramePredictor final : public ObstaclePredictor {
 public:
  PredictedMotion Predict(const TrackedObject& object) const override {
    const Sighting latest = object.latest();
    const Sighting earlier = SightingBefore(object.history, kVelocityBaseline);
    const Eigen::Vector3d v_WO = MeanVelocity(object.history, kVelocityBaseline);
    const double elapsed_s = (latest.t - earlier.t).seconds();
    return {[latest, v_WO](EpisodeTime t) {
              return Pose::Translation(latest.p_WO + v_WO * (t - latest.t).seconds());
            },
            [latest, earlier, elapsed_s](EpisodeTime t) -> Eigen::Matrix3d {
              const double dt_s = (t - latest.t).seconds();
              // Of one sighting: it may have any speed.
              if (!(elapsed_s > 0)) return latest.covariance_m2 + Isotropic(kPriorSpeed * dt_s);
              const double share = dt_s / elapsed_s;
              return (1 + share) * (1 + share) * latest.covariance_m2 +
                     share * share * earlier.covariance_m2;
            }};
  }
};

}  // namespace

std::unique_ptr<ObstaclePredictor> MakeTwoFramePredictor() {
  return std::make_unique<TwoFramePredictor>();
}

}  // namespace sidestep::sdf
