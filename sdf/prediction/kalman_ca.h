#pragma once

#include <memory>

#include "sidestep/sdf/prediction/motion_filter.h"
#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {

/// Constant acceleration with white noise of jerk, density 4 [m^2/s^5] an axis:
///   p' = p + v dt + a dt^2/2,  v' = v + a dt,  a' = a.
/// Source: Bar-Shalom, Li & Kirubarajan (2001), section 6.2.3.
extern const MotionModel kConstantAcceleration;

/// A Kalman filter on that model.
std::unique_ptr<ObstaclePredictor> MakeKalmanCaPredictor();

}  // namespace sidestep::sdf
