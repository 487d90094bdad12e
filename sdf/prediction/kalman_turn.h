#pragma once

#include <memory>

#include "sidestep/sdf/prediction/motion_filter.h"
#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {

/// Coordinated turn: a horizontal velocity that turns about z at a constant rate, straight on in z,
/// with white noise of acceleration and of the change of the rate:
///   x' = x + vx sin(w dt)/w - vy (1 - cos(w dt))/w,  vx' = vx cos(w dt) - vy sin(w dt),  and so
///   on.
/// Source: Bar-Shalom, Li & Kirubarajan (2001), section 11.7.1.
extern const MotionModel kCoordinatedTurn;

/// A Kalman filter on that model.
std::unique_ptr<ObstaclePredictor> MakeKalmanTurnPredictor();

}  // namespace sidestep::sdf
