#pragma once

#include <vector>

#include "sidestep/core/observations.h"
#include "sidestep/core/solid.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/shape_field.h"

namespace sidestep::bench {

/// What of a scenario never moves, exactly.
std::vector<PlacedShape> StaticShapes(const scenarios::Scenario& scenario);
HalfSpace FloorOf(const scenarios::Scenario& scenario);
/// Both.
StaticSolids StaticSolidsOf(const scenarios::Scenario& scenario);

/// What moves, and how it truly does; as values that outlive the scenario.
std::vector<sdf::MovingShape> TrueMotions(const scenarios::Scenario& scenario);

/// Everything solid of a scenario, where it truly will be.
sdf::ShapeField TrueWorld(const scenarios::Scenario& scenario, double max_distance_m);
/// The same with what moves as it was seen at one moment, whenever it is asked about; unclamped.
sdf::ShapeField TrueWorldAt(const scenarios::Scenario& scenario,
                            const std::vector<ObjectObservation>& moving);

}  // namespace sidestep::bench
