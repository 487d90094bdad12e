#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/solid.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// A solid of an MJCF file that never moves.
struct StaticGeom {
  std::string name;  ///< its own, or its body's; may be empty
  PlacedShape placed;
};

/// What stands still in an MJCF file.
struct StaticGeoms {
  std::vector<StaticGeom> solids;
  std::optional<double> floor_m;  ///< the height of its highest level plane
  /// Solids that are none here, and what moves; a line each.
  std::vector<std::string> left_out;
};

/// Reads the solids of an MJCF file of any kind, which may refer to others; meshes are the hulls by
/// which MuJoCo lets them touch. Geoms that touch nothing are pictures, and no matter.
/// @throws InputError, at the line that MuJoCo tells, for a file that it does not take.
StaticGeoms ReadStaticGeoms(const std::string& path);

/// The height of the lowest point of those solids of the robot that never move; where it has none,
/// 20 mm below the lowest point of all of them, for these are not to touch what it stands on.
/// Infinite for a robot without a solid. The world must have a floor, which is level.
double FootHeight(const World& world);

}  // namespace sidestep::sim
