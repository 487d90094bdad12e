#pragma once

#include <memory>

#include "sidestep/sdf/prediction/motion_filter.h"
#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {

/// Constant velocity with white noise of acceleration, density 0.1 [m^2/s^3] an axis:
///   p' = p + v dt,  v' = v,  Q = q [dt^3/3, dt^2/2; dt^2/2, dt].
/// Source: Bar-Shalom, Li & Kirubarajan (2001), section 6.2.2.
extern const MotionModel kConstantVelocity;

/// A Kalman filter on that model.
std::unique_ptr<ObstaclePredictor> MakeKalmanCvPredictor();

}  // namespace sidestep::sdf
