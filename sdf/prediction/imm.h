#pragma once

#include <memory>

#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {

/// Interacting multiple models: filters of constant velocity, constant acceleration and coordinated
/// turn run side by side, exchange what they believe in proportion to how likely each is, and the
/// prediction is the mean of theirs by those probabilities; its covariance counts their spread.
/// Source: Blom & Bar-Shalom, IEEE Trans. Automatic Control 33(8):780-783, 1988.
std::unique_ptr<ObstaclePredictor> MakeImmPredictor();

}  // namespace sidestep::sdf
