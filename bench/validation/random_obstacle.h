#pragma once

#include "sidestep/core/random.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// What an obstacle at random does at least and at most.
struct ObstacleRange {
  double least_m_s, most_m_s, most_m_s2;
};

/// Gives the scenario's first moving obstacle a motion at random: straight on, faster or slower, or
/// round a circle, from all sides through where the arm works, beginning far from it. Meant for an
/// arm that stands at the origin of W and works in front of itself, to its right first.
void SetRandomMotion(const ObstacleRange& range, RandomStream& random,
                     scenarios::Scenario& scenario);

}  // namespace sidestep::bench
