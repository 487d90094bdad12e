#pragma once

#include <string>
#include <vector>

#include "sidestep/core/model_folders.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/model_store.h"

namespace sidestep::sim {

/// Names in a world's model that do not come from the scenario.
inline constexpr const char* kRobotBody = "robot";  ///< at X_WB; holds the robot's bodies
inline constexpr const char* kFloorGeom = "floor";
inline constexpr const char* kOverviewCamera = "overview";
inline constexpr const char* kTopCamera = "top";

/// Builds the whole world as one MJCF text that refers to no other file: it is what is simulated,
/// stored with a recording and drawn from it.
///
/// - The robot, if the scenario has one: its MJCF (scenarios::RobotMjcf), its bodies in the body
///   `robot` at X_WB, its
///   defaults in a class of their own, so that they touch nothing else.
/// - Static obstacles: one fixed body each, body and geom named as in the scenario. Convex meshes
///   stand as the vertices of their hulls, `mesh/<name>`.
/// - Moving obstacles: one mocap body each, its contact geom of the same name. Their pose is
///   prescribed: they push and are never pushed, so what they touch is exact.
///   With an `appearance`, the contact geom is in group 4 (not drawn by default; its colour is
///   translucent, to be shown as a shell), and what `<appearance>.xml` in the folder of that name
///   draws by default stands inside it: geoms of group 2 that touch nothing, origin at the middle
///   of the shape's underside, x axis along the first leg of the motion (as far as it is level).
/// - Tags, where a box has them: a white plate and black squares, geoms of group 2 that touch
///   nothing, a tenth of a millimetre before the face.
/// - The floor, lights, and the cameras `overview` and `top`.
/// - Contacts between each of `mount_links` (bodies of the robot) and what it stands on are
///   excluded: the scenario's mount or, without one, the floor.
///
/// Physics: 1 ms steps, Euler. MuJoCo's Euler takes the joints' damping implicitly, which is all
/// the damping these models have, and holds the motors' torque over the step as a 1 kHz controller
/// does; the implicit integrator would add cost and no accuracy.
///
/// @param store of models that were compiled before, as those of appearances are; may be null.
/// @throws InputError for a model file that is missing, is not MJCF, refers to other files, or
/// cannot be merged.
std::string BuildWorldXml(const scenarios::Scenario& scenario,
                          const std::vector<std::string>& mount_links, const ModelFolders& models,
                          ModelStore* store = nullptr);

/// The same world for the physics alone: without geoms that are only seen, half of all, which
/// MuJoCo would place at each tick. As it was if a body's mass may be told by such geoms.
std::string WithoutPictures(std::string world_xml);

}  // namespace sidestep::sim
