#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sidestep/sdf/prediction/predictor.h"

namespace sidestep::sdf {

/// The names of all predictors, as scenarios write them.
std::vector<std::string> PredictorNames();

/// What one does, in a line. @throws std::invalid_argument for an unknown name.
std::string MeaningOfPredictor(const std::string& name);

/// @throws std::invalid_argument for an unknown name; the message lists those that exist.
std::unique_ptr<ObstaclePredictor> MakePredictor(const std::string& name);

}  // namespace sidestep::sdf
