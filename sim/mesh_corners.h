#pragma once

#include <Eigen/Core>
#include <string>

namespace sidestep::sim {

/// The corners of the triangles of a mesh file, each once: STL, as text or binary, or OBJ, by its
/// ending. For meshes that stand beside a robot's MJCF, of which only the hull counts; `sidestep
/// import` reads others. Shape 3 x N, in the file's unit.
/// @throws InputError, of the path, for a file that is missing, longer than 256 MiB, or no such
/// mesh: a triangle of corners that are not there, a number that is none.
Eigen::Matrix3Xd ReadMeshCorners(const std::string& path);

}  // namespace sidestep::sim
