#include "sidestep/sdf/prediction/stationary.h"

namespace sidestep::sdf {
namespace {

class StationaryPredictor final : public ObstaclePredictor {
 public:
  PredictedMotion Predict(const TrackedObject& object) const override {
    const Sighting& latest = object.latest();
    return {[latest](EpisodeTime) { return Pose::Translation(latest.p_WO); },
            [latest](EpisodeTime) { return latest.covariance_m2; }};
  }
};

}  // namespace

std::unique_ptr<ObstaclePredictor> MakeStationaryPredictor() {
  return std::make_unique<StationaryPredictor>();
}

}  // namespace sidestep::sdf
