#pragma once

#include <memory>

#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {

/// Everything stays where it was last seen. Its covariance is that of the sighting alone.
std::unique_ptr<ObstaclePredictor> MakeStationaryPredictor();

}  // namespace sidestep::sdf
