#include "sidestep/sdf/prediction/registry.h"

#include <stdexcept>

namespace sidestep::sdf {

#define SIDESTEP_PREDICTOR(name, make, file) std::unique_ptr<ObstaclePredictor> make();
#include "sidestep/sdf/prediction/predictors.def"
#undef SIDESTEP_PREDICTOR

namespace {

struct Entry {
  const char* name;
  std::unique_ptr<ObstaclePredictor> (*make)();
};
constexpr Entry kPredictors[] = {
#define SIDESTEP_PREDICTOR(name, make, file) {name, &(make)},
#include "sidestep/sdf/prediction/predictors.def"
#undef SIDESTEP_PREDICTOR
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

}  // namespace sidestep::sdf
