#include "sidestep/sdf/prediction/two_frame.h"

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
              const double share = elapsed_s > 0 ? (t - latest.t).seconds() / elapsed_s : 0;
              const double late = (1 + share) * latest.sigma_m, early = share * earlier.sigma_m;
              return (late * late + early * early) * Eigen::Matrix3d::Identity();
            }};
  }
};

}  // namespace

std::unique_ptr<ObstaclePredictor> MakeTwoFramePredictor() {
  return std::make_unique<TwoFramePredictor>();
}

}  // namespace sidestep::sdf
