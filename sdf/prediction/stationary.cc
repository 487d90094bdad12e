#include "sdf/prediction/stationary.h"

namespace sidestep {
namespace {

class StationaryPredictor final : public ObstaclePredictor {
 public:
  Pose PredictPose(const TrackedObject& object, EpisodeTime) const override {
    return object.X_WO();
  }
};

}  // namespace

std::unique_ptr<ObstaclePredictor> MakeStationaryPredictor() {
  return std::make_unique<StationaryPredictor>();
}

}  // namespace sidestep
