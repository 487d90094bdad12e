#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

namespace sidestep::sim {

/// The solids of a world by their role, as geom ids, ascending. Pictures (geoms that can touch
/// nothing: contype and conaffinity both 0) are no solids and in none of the lists.
struct WorldGeoms {
  std::vector<int> robot;   ///< in the body `robot` of world_xml.h
  std::vector<int> floor;   ///< the geom `floor`; none or one
  std::vector<int> fixed;   ///< all others that never move
  std::vector<int> moving;  ///< all others
};

WorldGeoms FindWorldGeoms(const mjModel& model);

/// Whether a body's pose is part of the model, and not of the state.
bool IsFixed(const mjModel& model, int body);

/// Whether the model excludes contacts between two bodies.
bool IsExcluded(const mjModel& model, int body1, int body2);

/// The name of the body that a geom belongs to; of a geom of the world itself, its own name.
std::string GeomOwner(const mjModel& model, int geom);

}  // namespace sidestep::sim
