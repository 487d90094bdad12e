#pragma once

#include <Eigen/Core>

namespace sidestep::sim {

/// The points of an MJCF mesh's `vertex` list. @param text may be null: no points.
/// @throws InputError, of `vertex`, for what is no list of three numbers each of at least four
/// points.
Eigen::Matrix3Xd ReadMeshVertices(const char* text);

/// Refuses vertices of a convex mesh that MuJoCo would take without a word and make nothing of: of
/// a mesh so small that its size counts as none, so flat that its hull is none, or far away.
/// @throws InputError, of `vertex`.
void CheckMeshVertices(const Eigen::Matrix3Xd& vertices);

}  // namespace sidestep::sim
