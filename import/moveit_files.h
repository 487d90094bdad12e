#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::imports {

/// What stands in a scene from elsewhere.
struct ImportedScene {
  std::vector<scenarios::StaticObstacle> obstacles;  ///< with names fit for a scenario, none twice
  std::optional<double> floor_m;                     ///< where there is one
  /// What was changed, and what could not be taken; a line each.
  std::vector<std::string> changed, left_out;
};

/// Positions of joints, by their names there.
struct NamedJoints {
  std::vector<std::string> names;
  std::vector<double> positions;
  std::string place;  ///< FILE:LINE: KEY, for complaints
  int line = 1;
};

/// Where a link is to be, by its name there, in the scene's frame.
struct NamedTarget {
  std::string link;
  Pose X_WL;
  std::string place;
  int line = 1;
};

/// From where to where.
struct ImportedRequest {
  std::optional<NamedJoints> start, goal;
  std::optional<NamedTarget> goal_pose;
  std::vector<std::string> left_out;
};

/// Reads a planning scene as MoveIt's messages write themselves in YAML, and as MotionBenchMaker
/// does: `world.collision_objects` with boxes, spheres, cylinders and meshes of inline vertices,
/// whose hull is taken.
/// @throws InputError FILE:LINE: KEY: WHY for a file that is none.
ImportedScene ReadMoveItScene(const std::string& path);
/// The same from text; `name` stands for the file in messages.
ImportedScene ParseMoveItScene(const std::string& text, const std::string& name);

/// Reads a motion plan request of the same kind: `start_state.joint_state` and the first of
/// `goal_constraints`, as joints or as a position and an orientation of a link.
/// @throws InputError FILE:LINE: KEY: WHY for a file that is none, or names no goal.
ImportedRequest ReadMoveItRequest(const std::string& path);
/// The same from text.
ImportedRequest ParseMoveItRequest(const std::string& text, const std::string& name);

/// A name of letters, digits, _ and - that is not in `taken`, and joins it.
std::string FreeName(const std::string& name, std::vector<std::string>& taken);

}  // namespace sidestep::imports
