#include "sdf/prediction/two_frame.h"

namespace sidestep {
namespace {

class TwoFramePredictor final : public ObstaclePredictor {
 public:
  Pose PredictPose(const TrackedObject& object, EpisodeTime t) const override {
    const Sighting& latest = object.latest();
    const Eigen::Vector3d v_WO = MeanVelocity(object.history, kVelocityBaseline);
    return Pose::Translation(latest.p_WO + v_WO * (t - latest.t).seconds());
  }
};

}  // namespace

std::unique_ptr<ObstaclePredictor> MakeTwoFramePredictor() {
  return std::make_unique<TwoFramePredictor>();
}

}  // namespace sidestep
