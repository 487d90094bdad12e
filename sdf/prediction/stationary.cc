#include "sidestep/sdf/prediction/stationary.h"

namespace sidestep::sdf {
namespace {

class StationaryPredictor final : public ObstaclePredictor {
 public:
  PredictedMotion Predict(const TrackedObject& object) const override {
    const Sighting& latest = object.latest();
    return {[latest](EpisodeTime) { return Pose::Translation(latest.p_WO); },
            [latest](EpisodeTime) -> Eigen::Matrix3d {
              return latest.sigma_m * latest.sigma_m * Eigen::Matrix3d::Identity();
            }};
  }
};

}  // namespace

std::unique_ptr<ObstaclePredictor> MakeStationaryPredictor() {
  return std::make_unique<StationaryPredictor>();
}

}  // namespace sidestep::sdf
