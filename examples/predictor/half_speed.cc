// A predictor that expects everything to slow down to half its speed. Copy this file to
// sdf/prediction/ and add the line of predictors.def beside it to sdf/prediction/predictors.def.
#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {
namespace {

class HalfSpeedPredictor final : public ObstaclePredictor {
 public:
  PredictedMotion Predict(const TrackedObject& object) const override {
    const Sighting seen = object.latest();
    const Eigen::Vector3d v_WO = 0.5 * MeanVelocity(object.history, kVelocityBaseline);
    PredictedMotion motion;
    motion.X_WO = [seen, v_WO](EpisodeTime t) {
      return Pose::Translation(seen.p_WO + v_WO * (t - seen.t).seconds());
    };
    // Sure of nothing but the sighting: as far off as the object may have gone.
    motion.covariance_m2 = [seen, v_WO](EpisodeTime t) -> Eigen::Matrix3d {
      const double gone_m = v_WO.norm() * (t - seen.t).seconds();
      return seen.covariance_m2 + Isotropic(gone_m);
    };
    return motion;
  }
};

}  // namespace

std::unique_ptr<ObstaclePredictor> MakeHalfSpeedPredictor() {
  return std::make_unique<HalfSpeedPredictor>();
}

}  // namespace sidestep::sdf
