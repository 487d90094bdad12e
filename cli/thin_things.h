#pragma once

#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Says on standard error what may fall between the workspace's cells, so that the planner does not
/// see it while the verdict does: with `sensor.cells: centre`, things thinner than a cell.
void WarnOfThinThings(const scenarios::Scenario& scenario);

}  // namespace sidestep::cli
