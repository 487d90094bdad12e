#include "sdf/prediction/registry.h"

#include <stdexcept>

#include "sdf/prediction/imm.h"
#include "sdf/prediction/kalman_ca.h"
#include "sdf/prediction/kalman_cv.h"
#include "sdf/prediction/kalman_turn.h"
#include "sdf/prediction/stationary.h"
#include "sdf/prediction/two_frame.h"

namespace sidestep {
namespace {

struct Entry {
  const char* name;
  std::unique_ptr<ObstaclePredictor> (*make)();
};

// To add a predictor: one line here, and its files beside this one.
constexpr Entry kPredictors[] = {
    {"imm", &MakeImmPredictor},
    {"kalman_ca", &MakeKalmanCaPredictor},
    {"kalman_cv", &MakeKalmanCvPredictor},
    {"kalman_turn", &MakeKalmanTurnPredictor},
    {"stationary", &MakeStationaryPredictor},
    {"two_frame", &MakeTwoFramePredictor},
};

}  // namespace

std::vector<std::string> PredictorNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kPredictors) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<ObstaclePredictor> MakePredictor(const std::string& name) {
  std::string known;
  for (const Entry& entry : kPredictors) {
    if (name == entry.name) return entry.make();
    known += known.empty() ? entry.name : std::string(", ") + entry.name;
  }
  throw std::invalid_argument("unknown predictor '" + name + "'; there are: " + known);
}

}  // namespace sidestep
