#pragma once

#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {

/// How the published files name their columns: the pair, the speed, and then PREFIX + CASE.
inline constexpr const char* kPairColumn = "pair";
inline constexpr const char* kSpeedColumn = "speed_m_per_s";
/// What the published tables of times go by.
inline constexpr const char* kVoxelsColumn = "voxels_per_side";
inline constexpr const char* kCollidingPrefix = "n_colliding_states_";
inline constexpr const char* kGpCostPrefix = "gp_cost_";
inline constexpr const char* kObstacleCostPrefix = "obstacle_cost_";

struct PublishedCase {
  const char* name;
  sdf::Knowledge knowledge;
  bool is_published;  ///< false: the case is ours
};
/// In the order of the published files, then ours.
inline constexpr PublishedCase kPublishedCases[] = {
    {"static", sdf::Knowledge::kStatic, true},
    {"execute_update", sdf::Knowledge::kExecuteAndUpdate, true},
    {"full_knowledge", sdf::Knowledge::kFullKnowledge, true},
    {"prediction", sdf::Knowledge::kPrediction, false}};

}  // namespace sidestep::bench
