// A library that is loaded while a program runs, linked with Sidestep's own libraries.
#include "plug_in.h"

#include "core/time.h"
#include "sidestep/core/time.h"
#include "sidestep/planner/registry.h"
#include "sidestep/sdf/prediction/registry.h"

int CountPlannersAndPredictors() {
  const sidestep::HorizonOffset outside(kOutsideSeconds);
  return outside.seconds() == 60 ? static_cast<int>(sidestep::planner::PlannerNames().size() +
                                                    sidestep::sdf::PredictorNames().size())
                                 : 0;
}
