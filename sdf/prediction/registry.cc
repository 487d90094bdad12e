#include "sidestep/sdf/prediction/registry.h"

#include <stdexcept>

namespace sidestep::sdf {

#define SIDESTEP_PREDICTOR(name, meaning, make, file) std::unique_ptr<ObstaclePredictor> make();
#include "sidestep/sdf/prediction/predictors.def"
#undef SIDESTEP_PREDICTOR

namespace {

struct Entry {
  const char* name;
  const char* meaning;
  std::unique_ptr<ObstaclePredictor> (*make)();
};
constexpr Entry kPredictors[] = {
#define SIDESTEP_PREDICTOR(name, meaning, make, file) {name, meaning, &(make)},
#include "sidestep/sdf/prediction/predictors.def"
#undef SIDESTEP_PREDICTOR
};

const Entry& Find(const std::string& name) {
  std::string known;
  for (const Entry& entry : kPredictors) {
    if (name == entry.name) return entry;
    known += known.empty() ? entry.name : std::string(", ") + entry.name;
  }
  throw std::invalid_argument("unknown predictor '" + name + "'; there are: " + known);
}

}  // namespace

std::vector<std::string> PredictorNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kPredictors) names.emplace_back(entry.name);
  return names;
}

std::string MeaningOfPredictor(const std::string& name) { return Find(name).meaning; }

std::unique_ptr<ObstaclePredictor> MakePredictor(const std::string& name) {
  return Find(name).make();
}

}  // namespace sidestep::sdf
